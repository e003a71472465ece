// Decodes one Draco stream from standard input into a binary PLY on standard output, or the other
// way round, confined by limits that it sets on itself. Started by the server for every Draco
// upload and for large Draco results.

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/draco.h"
#include "api/codec/draco_child.h"
#include "api/codec/ply.h"
#include "api/codec/sandbox.h"
#include "api/codec/text.h"

namespace {

constexpr const char* kUsage =
    "usage: lpf-decode decode MEMORY_BYTES CPU_SECONDS WALL_SECONDS MAX_POINTS MAX_FACES "
    "< in.drc > out.ply, or lpf-decode encode MEMORY_BYTES CPU_SECONDS WALL_SECONDS "
    "QUANTIZATION_BITS DOUBLE_POSITIONS DOUBLE_SOURCE < in.ply > out.drc";

/// What stands on the command line.
class Arguments {
public:
    Arguments(int argc, char** argv) : words_(argv + 1, argv + argc) {}

    [[nodiscard]] bool ask_to(std::string_view what, std::size_t count) const {
        return words_.size() == count && words_[0] == what;
    }
    [[nodiscard]] std::uint64_t number(std::size_t i) const { return std::stoull(words_.at(i)); }

    [[nodiscard]] lpf::SandboxLimits sandbox() const {
        return {number(1), static_cast<unsigned>(number(2)), static_cast<unsigned>(number(3))};
    }

private:
    std::vector<std::string> words_;
};

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

void decode(std::uint64_t max_points, std::uint64_t max_faces) {
    const lpf::DecodeLimits limits{
        .max_points = max_points, .max_faces = max_faces, .decode_helper = {}};
    const lpf::Document document = lpf::decode_draco_unprotected(map_standard_input(), limits);
    const lpf::EncodeOptions options{.double_positions = document.double_positions,
                                     .encode_helper = {}};
    std::vector<lpf::Warning> lost;
    write_all(STDOUT_FILENO, lpf::encode_ply(document, options, lost));
}

void encode(const lpf::EncodeOptions& options, bool double_source) {
    const lpf::DecodeLimits any_size{
        .max_points = UINT32_MAX, .max_faces = UINT32_MAX, .decode_helper = {}};
    lpf::Document document = lpf::decode_ply(map_standard_input(), any_size);
    document.double_positions = double_source;
    std::vector<lpf::Warning> lost;
    write_all(STDOUT_FILENO, lpf::encode_draco_here(document, options, lost));
    for (const lpf::Warning& warning : lost) {
        write_all(STDERR_FILENO, lpf::message_of(warning.code, "\t", warning.detail, "\n"));
    }
}

void work(const Arguments& arguments) {
    const bool decodes = arguments.ask_to("decode", 6);
    if (!decodes && !arguments.ask_to("encode", 7)) {
        lpf::fail(lpf::ErrorCode::Internal, kUsage);
    }
    lpf::confine_this_process(arguments.sandbox());
    if (decodes) return decode(arguments.number(4), arguments.number(5));
    encode({.format = lpf::FileFormat::Draco,
            .quantization_bits = static_cast<int>(arguments.number(4)),
            .double_positions = arguments.number(5) != 0,
            .encode_helper = {}},
           arguments.number(6) != 0);
}

int report(lpf::ErrorCode code, std::string_view message) {
    write_all(STDERR_FILENO, lpf::message_of(static_cast<int>(code), "\n", message));
    return lpf::kDecodeHelperRefused;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        work(Arguments(argc, argv));
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
