#include "api/codec/helper_process.h"

#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include "api/codec/text.h"

namespace lpf {
namespace {

/// Given to a helper beyond its time, to end by itself and say why.
constexpr unsigned kGraceSeconds = 5;

/// What the helper is told to pass on to the three standard streams, and nothing else.
class SpawnActions {
public:
    explicit SpawnActions(const HelperStreams& streams) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_adddup2(&actions_, streams.in.descriptor(), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, streams.out.descriptor(), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, streams.error.descriptor(), STDERR_FILENO);
        posix_spawn_file_actions_addclosefrom_np(&actions_, 3);
        posix_spawnattr_init(&attributes_);
        // Signals that the caller blocks or ignores must end the helper nevertheless.
        sigset_t none;
        sigset_t all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    }
    ~SpawnActions() {
        posix_spawn_file_actions_destroy(&actions_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;

    pid_t start(std::vector<std::string> arguments, std::vector<std::string> environment) {
        pid_t child = 0;
        const int error =
            posix_spawn(&child, arguments[0].c_str(), &actions_, &attributes_,
                        pointers_to(arguments).data(), pointers_to(environment).data());
        if (error != 0) {
            fail(ErrorCode::Internal, "cannot start ", arguments[0], ": ", std::strerror(error));
        }
        return child;
    }

private:
    static std::vector<char*> pointers_to(std::vector<std::string>& texts) {
        std::vector<char*> pointers;
        for (std::string& text : texts) pointers.push_back(text.data());
        pointers.push_back(nullptr);
        return pointers;
    }

    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

/// How to allocate: a process that soon ends takes large pages, all from one heap, and keeps them.
constexpr const char* kAllocation =
    "GLIBC_TUNABLES=glibc.malloc.hugetlb=1:glibc.malloc.mmap_threshold=1073741824:"
    "glibc.malloc.trim_threshold=1073741824";

/// Nothing of the caller's. Where the helper is built with a sanitizer, it must know where to
/// report.
std::vector<std::string> helper_environment() {
    std::vector<std::string> environment{kAllocation};
#ifdef LPF_SANITIZED
    for (const char* name : {"ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS", "LSAN_OPTIONS"}) {
        if (const char* value = std::getenv(name)) {
            environment.push_back(message_of(name, "=", value));
        }
    }
#endif
    return environment;
}

void tell(const Execution& execution, std::string_view phase, unsigned done, unsigned total) {
    if (execution.progress) execution.progress({phase, done, total, "seconds", 0.0});
}

/// Waits until the process has ended or the time is up, and tells every second.
bool ends_in_time(int handle, std::string_view phase, unsigned seconds,
                  const Execution& execution) {
    for (unsigned second = 0; second < seconds; ++second) {
        tell(execution, phase, second, seconds);
        pollfd event{handle, POLLIN, 0};
        int ready = 0;
        while ((ready = poll(&event, 1, 1000)) < 0 && errno == EINTR) {
        }
        if (ready != 0) return true;
    }
    return false;
}

/// Waits for the end, without taking the status.
void wait_for_end(pid_t child) {
    siginfo_t info{};
    while (waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT) != 0) {
        if (errno != EINTR) fail(ErrorCode::Internal, "waitid: ", std::strerror(errno));
    }
}

int take_status(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) fail(ErrorCode::Internal, "waitpid: ", std::strerror(errno));
    }
    return status;
}

}  // namespace

int run_helper(const std::vector<std::string>& arguments, const HelperStreams& streams,
               std::string_view phase, unsigned wall_seconds, const Execution& execution) {
    throw_if_cancelled(execution);
    const pid_t child = SpawnActions(streams).start(arguments, helper_environment());
    {
        // Its number stays taken until its status is, so this cannot kill a stranger.
        const std::stop_callback kill_at_stop(execution.stop, [child] { kill(child, SIGKILL); });
        const int handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
        if (handle >= 0) {  // before Linux 5.3 the helper's own alarm must do
            const bool ended = ends_in_time(handle, phase, wall_seconds + kGraceSeconds, execution);
            if (!ended) kill(child, SIGKILL);
            close(handle);
        }
        wait_for_end(child);
    }
    const int status = take_status(child);
    throw_if_cancelled(execution);
    return status;
}

}  // namespace lpf
