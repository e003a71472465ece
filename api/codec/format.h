#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/document.h"
#include "core/base/parallel.h"

namespace lpf {

/// What a file may claim at most. Claims are checked before memory is taken for them.
struct DecodeLimits {
    std::uint64_t max_points = 20'000'000;
    std::uint64_t max_faces = 40'000'000;

    /// Program that decodes Draco under limits of its own (built as `lpf-decode`). Empty: decode in
    /// this process, current bitstreams only, after checking their counts.
    std::string decode_helper = default_decode_helper();
    std::uint64_t helper_memory_bytes = 8ULL << 30;  ///< ceiling of the helper's address space
    unsigned helper_cpu_seconds = 60;
    unsigned helper_wall_seconds = 120;

    /// `lpf-decode` in the folder of the running program, or empty if there is none.
    [[nodiscard]] static std::string default_decode_helper();
};

struct EncodeOptions {
    FileFormat format = FileFormat::PlyBinary;
    int quantization_bits = 0;               ///< Draco positions: 1 to 30 bits; 0 = exact
    bool double_positions = false;           ///< float64 coordinates, else float32
    std::vector<std::string> comments = {};  ///< lines put before the document's own comments

    /// Program that encodes large Draco results (the same as decodes them), so that they can be
    /// stopped. Empty: encode in this process.
    std::string encode_helper = DecodeLimits::default_decode_helper();
};

/// The format by content alone, whatever the file was called; nothing if it is none that is read
/// here. A PLY whose format line cannot be read counts as ASCII: decoding it says what is wrong.
[[nodiscard]] std::optional<FileFormat> sniff(std::span<const std::byte> bytes);

/// Reads PLY (ASCII, both byte orders) and Draco (point clouds, meshes). Points with a NaN or
/// infinite coordinate are dropped with a warning. A file without any point is a document with 0.
/// @throws Error{UnsupportedFormat} for other content, naming what it looks like
/// @throws Error{MalformedFile} with line or byte offset; also if no point has finite coordinates
/// @throws Error{LimitExceeded} naming the limit; Error{Cancelled} at once when the stop token
/// fires
[[nodiscard]] Document decode(std::span<const std::byte> bytes, const DecodeLimits& limits = {},
                              const Execution& execution = {});

/// Writes a document. Points and faces keep their order in every format.
/// @param lost  receives a warning for everything the format cannot hold
/// @throws Error{InvalidParameter, "quantizationBits"} outside 0 to 30; Error{Cancelled}
[[nodiscard]] std::string encode(const Document& document, const EncodeOptions& options,
                                 std::vector<Warning>& lost, const Execution& execution = {});

/// "application/ply" for all PLY kinds and "application/vnd.draco": no type is registered for
/// either format, so these are names of this project. Uploads are told by content, never by their
/// type.
[[nodiscard]] std::string_view media_type(FileFormat format);

/// File name ending without its dot: "ply" or "drc".
[[nodiscard]] std::string_view file_extension(FileFormat format);

/// "ply" (binary, little-endian), "ply-ascii", "ply-big-endian", "drc".
[[nodiscard]] std::string_view format_name(FileFormat format);
[[nodiscard]] std::optional<FileFormat> parse_format_name(std::string_view name);

/// Every format that is read and written, best first.
[[nodiscard]] std::span<const FileFormat> all_formats();

}  // namespace lpf
