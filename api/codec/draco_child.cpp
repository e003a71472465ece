#include "api/codec/draco_child.h"

#include <sys/wait.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <span>
#include <string>
#include <string_view>

#include "api/codec/helper_process.h"
#include "api/codec/ply.h"
#include "api/codec/ply_columns.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

constexpr std::uint64_t kProgramBytes = 512ULL << 20;

/// Of encoding: the file, its columns, their copies in Draco and the stream.
constexpr std::uint64_t kBytesPerInputByte = 16;
constexpr unsigned kEncodeSeconds = 600;

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What the helper wrote: a code, a tab and a detail in every line.
std::vector<Warning> warnings_in(std::string_view text) {
    std::vector<Warning> warnings;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        const std::size_t tab = std::min(line.find('\t'), line.size());
        const std::size_t after = std::min(tab + 1, line.size());
        warnings.push_back({std::string(line.substr(0, tab)), std::string(line.substr(after))});
    }
    return warnings;
}

/// Room for what the stream claims, several times over, and never more than the ceiling.
std::uint64_t memory_for(const DracoClaim& claim, std::uint64_t file_bytes,
                         const DecodeLimits& limits) {
    constexpr std::uint64_t kPerPoint = 1024;
    constexpr std::uint64_t kPerFace = 1024;
    const std::uint64_t wanted =
        kProgramBytes + 8 * file_bytes + kPerPoint * claim.points + kPerFace * claim.faces;
    return std::min(wanted, limits.helper_memory_bytes);
}

[[noreturn]] void throw_refusal(std::span<const std::byte> report, std::uint64_t memory) {
    const std::string_view text = text_of(report);
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
    if (signal == SIGXCPU || signal == SIGALRM || signal == SIGKILL || signal == SIGXFSZ) {
        fail(ErrorCode::LimitExceeded,
             "decoding the Draco stream was stopped at its limits: ", limits.helper_cpu_seconds,
             " s of processor time, ", limits.helper_wall_seconds, " s in all, ", memory >> 20,
             " MiB of memory");
    }
    malformed("the Draco stream is damaged: the decoder crashed on it");
}

}  // namespace

void decode_draco_to_ply(std::span<const std::byte> bytes, const DracoClaim& claim,
                         const DecodeLimits& limits, HelperStreams& streams,
                         const Execution& execution) {
    streams.in.write_all(bytes, execution);
    const std::uint64_t memory = memory_for(claim, bytes.size(), limits);
    const int status = run_helper(
        {limits.decode_helper, "decode", std::to_string(memory),
         std::to_string(limits.helper_cpu_seconds), std::to_string(limits.helper_wall_seconds),
         std::to_string(limits.max_points), std::to_string(limits.max_faces)},
        streams, kDecodePhase, limits.helper_wall_seconds, execution);
    throw_unless_done(status, streams.error, memory, limits);
}

Document decode_draco_in_child(std::span<const std::byte> bytes, const DracoClaim& claim,
                               const DecodeLimits& limits, const Execution& execution) {
    HelperStreams streams;
    decode_draco_to_ply(bytes, claim, limits, streams, execution);
    Document document = decode_ply(streams.out.map(), limits, execution);
    document.format = FileFormat::Draco;
    return document;
}

std::string encode_draco_in_child(const Document& document, const EncodeOptions& options,
                                  std::vector<Warning>& lost, const Execution& execution) {
    HelperStreams streams;
    std::size_t bytes = 0;
    {
        EncodeOptions exact;
        exact.comments = options.comments;
        exact.double_positions = true;
        const std::string file = encode_ply(document, exact, lost, part_of(execution, 0, 0.5));
        streams.in.write_all(std::as_bytes(std::span(file)), execution);
        bytes = file.size();
    }
    const int status = run_helper(
        {options.encode_helper, "encode",
         std::to_string(kProgramBytes + kBytesPerInputByte * bytes), std::to_string(kEncodeSeconds),
         std::to_string(kEncodeSeconds), std::to_string(options.quantization_bits),
         options.double_positions ? "1" : "0", document.double_positions ? "1" : "0"},
        streams, kEncodePhase, kEncodeSeconds, part_of(execution, 0.5, 1));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        fail(ErrorCode::Internal, "encoding Draco failed: ", text_of(streams.error.map()));
    }
    for (const Warning& warning : warnings_in(text_of(streams.error.map())))
        lost.push_back(warning);
    return std::string(text_of(streams.out.map()));
}

}  // namespace lpf
