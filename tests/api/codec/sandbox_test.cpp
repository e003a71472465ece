#include "api/codec/sandbox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <vector>

namespace lpf {
namespace {

constexpr SandboxLimits kLimits{.memory_bytes = 1ULL << 30, .cpu_seconds = 20, .wall_seconds = 20};

/// What a process does once it is confined; 0 if it comes to an end by itself.
template <typename Work>
[[noreturn]] void confined(const SandboxLimits& limits, Work work) {
    confine_this_process(limits);
    work();
    _exit(0);
}

void compute() {
    std::vector<double> numbers(1 << 20, 1.5);
    try {
        numbers.at(numbers.size());
    } catch (const std::out_of_range&) {
        return;
    }
    _exit(1);
}

TEST(Sandbox, LetsComputingAndExceptionsPass) {
    EXPECT_EXIT(confined(kLimits, compute), testing::ExitedWithCode(0), "");
}

TEST(Sandbox, EndsAbortAsASignal) {
    EXPECT_EXIT(confined(kLimits, [] { std::abort(); }), testing::KilledBySignal(SIGABRT), "");
}

TEST(Sandbox, EndsWhatTakesTooLong) {
    SandboxLimits limits = kLimits;
    limits.wall_seconds = 1;
    const auto wait = [] {
        for (std::atomic<unsigned> i = 0;; ++i) {
        }
    };
    EXPECT_EXIT(confined(limits, wait), testing::KilledBySignal(SIGALRM), "");
}

#ifndef LPF_SANITIZED

TEST(Sandbox, RefusesMoreMemory) {
    const auto swallow = [] {
        try {
            const std::vector<char> memory(2ULL << 30);
            _exit(memory[0] + 1);
        } catch (const std::bad_alloc&) {
        }
    };
    EXPECT_EXIT(confined(kLimits, swallow), testing::ExitedWithCode(0), "");
}

struct Escape {
    const char* name;
    void (*work)();
};

void PrintTo(const Escape& escape, std::ostream* out) { *out << escape.name; }

class SandboxEscape : public testing::TestWithParam<Escape> {};

TEST_P(SandboxEscape, IsTheEnd) {
    EXPECT_EXIT(confined(kLimits, GetParam().work), testing::KilledBySignal(SIGSYS), "");
}

INSTANTIATE_TEST_SUITE_P(
    Calls, SandboxEscape,
    testing::Values(Escape{"File", [] { (void)open("/proc/self/maps", O_RDONLY); }},
                    Escape{"Socket", [] { (void)socket(AF_INET, SOCK_STREAM, 0); }},
                    Escape{"Process", [] { (void)fork(); }},
                    Escape{"Program", [] { execl("/bin/true", "true", nullptr); }},
                    Escape{"Signal", [] { (void)kill(getppid(), SIGTERM); }},
                    Escape{"Clock", [] { (void)alarm(0); }},
                    Escape{"Code",
                           [] {
                               (void)mmap(nullptr, 4096, PROT_READ | PROT_EXEC,
                                          MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                           }}),
    [](const auto& test) { return std::string(test.param.name); });

#endif

}  // namespace
}  // namespace lpf
