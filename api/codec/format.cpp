#include "api/codec/format.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "api/codec/draco.h"
#include "api/codec/foreign.h"
#include "api/codec/ply.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

struct FormatFacts {
    FileFormat format;
    std::string_view name;
    std::string_view media_type;
    std::string_view extension;
};

constexpr std::array<FormatFacts, 4> kFormats{{
    {FileFormat::PlyBinary, "ply", "application/ply", "ply"},
    {FileFormat::PlyAscii, "ply-ascii", "application/ply", "ply"},
    {FileFormat::PlyBigEndian, "ply-big-endian", "application/ply", "ply"},
    {FileFormat::Draco, "drc", "application/vnd.draco", "drc"},
}};

const FormatFacts& facts_of(FileFormat format) {
    return *std::find_if(kFormats.begin(), kFormats.end(),
                         [&](const FormatFacts& facts) { return facts.format == format; });
}

std::string_view text_of(std::span<const std::byte> bytes, std::size_t most) {
    return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), most)};
}

bool begins_like_ply(std::span<const std::byte> bytes) { return text_of(bytes, 3) == "ply"; }

FileFormat ply_kind(std::span<const std::byte> bytes) {
    const std::string_view header = text_of(bytes, 65536);
    const std::string_view rest = header.substr(std::min(header.find("format"), header.size()));
    const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
    if (line.find("binary_little_endian") != line.npos) return FileFormat::PlyBinary;
    if (line.find("binary_big_endian") != line.npos) return FileFormat::PlyBigEndian;
    return FileFormat::PlyAscii;
}

}  // namespace

std::string DecodeLimits::default_decode_helper() {
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return {};
    const std::filesystem::path helper = self.parent_path() / "lpf-decode";
    return std::filesystem::is_regular_file(helper, error) ? helper.string() : std::string();
}

std::optional<FileFormat> sniff(std::span<const std::byte> bytes) {
    if (text_of(bytes, 5) == "DRACO") return FileFormat::Draco;
    const std::string_view start = text_of(bytes, 4);
    const bool is_ply = start.size() == 4 && start.starts_with("ply") &&
                        std::string_view(" \t\r\n").find(start[3]) != std::string_view::npos;
    if (is_ply) return ply_kind(bytes);
    return std::nullopt;
}

Document decode(std::span<const std::byte> bytes, const DecodeLimits& limits,
                const Execution& execution) {
    if (sniff(bytes) == FileFormat::Draco) return decode_draco(bytes, limits, execution);
    // Also what only begins like a PLY goes there, because its reader can say what is wrong.
    if (begins_like_ply(bytes)) return decode_ply(bytes, limits, execution);
    fail(ErrorCode::UnsupportedFormat, "the file is neither PLY nor Draco; it looks like ",
         describe_foreign(bytes));
}

std::string encode(const Document& document, const EncodeOptions& options,
                   std::vector<Warning>& lost, const Execution& execution) {
    if (options.quantization_bits < 0 || options.quantization_bits > 30) {
        throw Error(ErrorCode::InvalidParameter,
                    message_of("quantizationBits is ", options.quantization_bits,
                               "; it must be 1 to 30, or 0 for exact coordinates"),
                    "quantizationBits");
    }
    if (options.format == FileFormat::Draco)
        return encode_draco(document, options, lost, execution);
    return encode_ply(document, options, lost, execution);
}

std::string_view media_type(FileFormat format) { return facts_of(format).media_type; }

std::string_view file_extension(FileFormat format) { return facts_of(format).extension; }

std::string_view format_name(FileFormat format) { return facts_of(format).name; }

std::optional<FileFormat> parse_format_name(std::string_view name) {
    for (const FormatFacts& facts : kFormats) {
        if (facts.name == name) return facts.format;
    }
    return std::nullopt;
}

std::span<const FileFormat> all_formats() {
    static constexpr std::array<FileFormat, 4> kAll{FileFormat::PlyBinary, FileFormat::PlyAscii,
                                                    FileFormat::PlyBigEndian, FileFormat::Draco};
    return kAll;
}

}  // namespace lpf
