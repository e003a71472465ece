#include "api/codec/draco_child.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "api/codec/ply.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

/// A file without a name that lives in memory until it is closed.
class MemoryFile {
public:
    MemoryFile() : descriptor_(memfd_create("lpf-decode", MFD_CLOEXEC)) {
        if (descriptor_ < 0) fail(ErrorCode::Internal, "memfd_create: ", std::strerror(errno));
    }
    ~MemoryFile() {
        if (mapping_ != nullptr) munmap(mapping_, size_);
        close(descriptor_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }

    void write_all(std::span<const std::byte> bytes) {
        while (!bytes.empty()) {
            const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) fail(ErrorCode::OutOfMemory, "memfd: ", std::strerror(errno));
            bytes = bytes.subspan(static_cast<std::size_t>(written));
        }
        lseek(descriptor_, 0, SEEK_SET);
    }

    /// The whole content; valid as long as this object.
    std::span<const std::byte> map() {
        struct stat status {};
        if (fstat(descriptor_, &status) != 0 || status.st_size == 0) return {};
        size_ = static_cast<std::size_t>(status.st_size);
        void* const mapping = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
        if (mapping == MAP_FAILED) fail(ErrorCode::OutOfMemory, "mmap: ", std::strerror(errno));
        mapping_ = mapping;
        return {static_cast<const std::byte*>(mapping_), size_};
    }

private:
    int descriptor_;
    void* mapping_ = nullptr;
    std::size_t size_ = 0;
};

/// What the helper is told to pass on to the three standard streams, and nothing else.
class SpawnActions {
public:
    SpawnActions(const MemoryFile& in, const MemoryFile& out, const MemoryFile& error) {
        posix_spawn_file_actions_init(&actions_);
        posix_spawn_file_actions_adddup2(&actions_, in.descriptor(), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, out.descriptor(), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions_, error.descriptor(), STDERR_FILENO);
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

    pid_t start(std::vector<std::string> arguments) {
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        std::array<char*, 1> environment{nullptr};
        pid_t child = 0;
        const int error =
            posix_spawn(&child, argv[0], &actions_, &attributes_, argv.data(), environment.data());
        if (error != 0) {
            fail(ErrorCode::Internal, "cannot start ", arguments[0], ": ", std::strerror(error));
        }
        return child;
    }

private:
    posix_spawn_file_actions_t actions_{};
    posix_spawnattr_t attributes_{};
};

/// Room for what the stream claims, several times over, and never more than the ceiling.
std::uint64_t memory_for(const DracoClaim& claim, std::uint64_t file_bytes,
                         const DecodeLimits& limits) {
    constexpr std::uint64_t kProgram = 512ULL << 20;
    constexpr std::uint64_t kPerPoint = 1024;
    constexpr std::uint64_t kPerFace = 1024;
    const std::uint64_t wanted =
        kProgram + 8 * file_bytes + kPerPoint * claim.points + kPerFace * claim.faces;
    return std::min(wanted, limits.helper_memory_bytes);
}

int wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR) fail(ErrorCode::Internal, "waitpid: ", std::strerror(errno));
    }
    return status;
}

[[noreturn]] void throw_refusal(std::span<const std::byte> report, std::uint64_t memory) {
    const std::string_view text(reinterpret_cast<const char*>(report.data()), report.size());
    const std::size_t line_end = text.find('\n');
    int code = 0;
    (void)std::from_chars(text.data(), text.data() + std::min(line_end, text.size()), code);
    const bool has_message = line_end != text.npos;
    const std::string message(has_message ? text.substr(line_end + 1) : "no reason was given");
    if (code == static_cast<int>(ErrorCode::OutOfMemory)) {
        fail(ErrorCode::LimitExceeded, "decoding the Draco stream needs more than ", memory >> 20,
             " MiB, the limit for its size and counts");
    }
    if (code == static_cast<int>(ErrorCode::LimitExceeded)) {
        throw Error(ErrorCode::LimitExceeded, message);
    }
    const bool own_fault = code == static_cast<int>(ErrorCode::Internal);
    throw Error(own_fault ? ErrorCode::Internal : ErrorCode::MalformedFile, message);
}

void throw_unless_done(int status, MemoryFile& report, std::uint64_t memory,
                       const DecodeLimits& limits) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    if (WIFEXITED(status) && WEXITSTATUS(status) == kDecodeHelperRefused) {
        throw_refusal(report.map(), memory);
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127) {
        fail(ErrorCode::Internal, "cannot run the decode helper ", limits.decode_helper);
    }
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL) {
        fail(ErrorCode::LimitExceeded,
             "decoding the Draco stream was stopped at its limits: ", limits.helper_cpu_seconds,
             " s of processor time, ", limits.helper_wall_seconds, " s in all, ", memory >> 20,
             " MiB of memory");
    }
    malformed("the Draco stream is damaged: the decoder crashed on it");
}

}  // namespace

Document decode_draco_in_child(std::span<const std::byte> bytes, const DracoClaim& claim,
                               const DecodeLimits& limits) {
    MemoryFile input;
    MemoryFile output;
    MemoryFile report;
    input.write_all(bytes);
    const std::uint64_t memory = memory_for(claim, bytes.size(), limits);
    const pid_t child = SpawnActions(input, output, report)
                            .start({limits.decode_helper, std::to_string(limits.max_points),
                                    std::to_string(limits.max_faces), std::to_string(memory),
                                    std::to_string(limits.helper_cpu_seconds),
                                    std::to_string(limits.helper_wall_seconds)});
    throw_unless_done(wait_for(child), report, memory, limits);
    Document document = decode_ply(output.map(), limits);
    document.format = FileFormat::Draco;
    return document;
}

}  // namespace lpf
