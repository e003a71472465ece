// Decodes one Draco stream from standard input into a binary PLY on standard output, under limits
// that it sets on itself. Started by the server for every Draco upload.

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/draco.h"
#include "api/codec/draco_child.h"
#include "api/codec/ply.h"
#include "api/codec/text.h"

namespace {

struct Arguments {
    lpf::DecodeLimits limits;
    std::uint64_t memory_bytes = 0;
};

Arguments parse_arguments(int argc, char** argv) {
    if (argc != 6) {
        lpf::fail(lpf::ErrorCode::Internal,
                  "usage: lpf-decode MAX_POINTS MAX_FACES MEMORY_BYTES CPU_SECONDS WALL_SECONDS "
                  "< in.drc > out.ply");
    }
    Arguments arguments;
    arguments.limits.max_points = std::stoull(argv[1]);
    arguments.limits.max_faces = std::stoull(argv[2]);
    arguments.memory_bytes = std::stoull(argv[3]);
    arguments.limits.helper_cpu_seconds = static_cast<unsigned>(std::stoul(argv[4]));
    arguments.limits.helper_wall_seconds = static_cast<unsigned>(std::stoul(argv[5]));
    return arguments;
}

void limit(int resource, std::uint64_t value) {
    const rlimit bound{value, value};
    if (setrlimit(static_cast<__rlimit_resource>(resource), &bound) != 0) {
        lpf::fail(lpf::ErrorCode::Internal, "lpf-decode: cannot limit resource ", resource);
    }
}

void limit_this_process(const Arguments& arguments) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, arguments.limits.helper_cpu_seconds);
    alarm(arguments.limits.helper_wall_seconds);
    // Sanitizers reserve terabytes of address space for themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    limit(RLIMIT_AS, arguments.memory_bytes);
#endif
}

std::span<const std::byte> map_standard_input() {
    struct stat status {};
    if (fstat(STDIN_FILENO, &status) != 0 || status.st_size == 0) return {};
    const auto size = static_cast<std::size_t>(status.st_size);
    void* const mapping = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
    if (mapping == MAP_FAILED && errno == ENOMEM) throw std::bad_alloc();
    if (mapping == MAP_FAILED) {
        lpf::fail(lpf::ErrorCode::Internal, "lpf-decode: standard input is not a file");
    }
    return {static_cast<const std::byte*>(mapping), size};
}

void write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = write(descriptor, bytes.data(), bytes.size());
        if (written <= 0) lpf::fail(lpf::ErrorCode::OutOfMemory, "lpf-decode: cannot write");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void decode(const Arguments& arguments) {
    const lpf::Document document =
        lpf::decode_draco_unprotected(map_standard_input(), arguments.limits);
    lpf::EncodeOptions options;
    options.double_positions = document.double_positions;
    std::vector<lpf::Warning> lost;
    write_all(STDOUT_FILENO, lpf::encode_ply(document, options, lost));
}

int report(lpf::ErrorCode code, std::string_view message) {
    std::fprintf(stderr, "%d\n%.*s", static_cast<int>(code), static_cast<int>(message.size()),
                 message.data());
    return lpf::kDecodeHelperRefused;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        const Arguments arguments = parse_arguments(argc, argv);
        limit_this_process(arguments);
        decode(arguments);
        return 0;
    } catch (const lpf::Error& error) {
        return report(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return report(lpf::ErrorCode::OutOfMemory, "out of memory");
    } catch (const std::exception& error) {
        return report(lpf::ErrorCode::MalformedFile,
                      lpf::message_of("the Draco stream is damaged: ", error.what()));
    }
}
