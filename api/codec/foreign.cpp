#include "api/codec/foreign.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include "api/codec/text.h"

namespace lpf {
namespace {

using namespace std::string_view_literals;

struct Signature {
    std::string_view bytes;
    std::string_view meaning;
};

constexpr std::array kSignatures{
    Signature{"version https://git-lfs"sv,
              "a Git LFS pointer instead of the file itself; fetch it with 'git lfs pull'"sv},
    Signature{"\x1f\x8b"sv, "gzip data; decompress it first"sv},
    Signature{"PK\x03\x04"sv, "a ZIP archive; unpack it first"sv},
    Signature{"\x28\xb5\x2f\xfd"sv, "zstd data; decompress it first"sv},
    Signature{"BZh"sv, "bzip2 data; decompress it first"sv},
    Signature{"\xfd"
              "7zXZ"sv,
              "xz data; decompress it first"sv},
    Signature{"\xef\xbb\xbfply"sv,
              "a PLY file with a byte order mark before it; remove the mark"sv},
    Signature{"LASF"sv, "a LAS or LAZ point cloud"sv},
    Signature{"ASTM-E57"sv, "an E57 scan"sv},
    Signature{"# .PCD"sv, "a PCD point cloud"sv},
    Signature{"glTF"sv, "a binary glTF model"sv},
    Signature{"\x93NUMPY"sv, "a NumPy array"sv},
    Signature{"OFF"sv, "an OFF mesh"sv},
    Signature{"COFF"sv, "an OFF mesh"sv},
    Signature{"NOFF"sv, "an OFF mesh"sv},
    Signature{"solid "sv, "an STL mesh"sv},
    Signature{"\x89PNG"sv, "a PNG image"sv},
    Signature{"\xff\xd8\xff"sv, "a JPEG image"sv},
    Signature{"%PDF"sv, "a PDF document"sv},
    Signature{"<?xml"sv, "an XML document"sv},
    Signature{"{"sv, "a JSON document"sv},
};

/// The first line that is neither empty nor a '#' comment, without blanks around it.
std::string_view first_line_of_content(std::string_view text) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::size_t begin = line.find_first_not_of(" \t");
        if (begin == line.npos || line[begin] == '#') continue;
        line.remove_prefix(begin);
        return line.substr(0, line.find_last_not_of(" \t") + 1);
    }
    return {};
}

bool is_html(std::string_view text) {
    std::string start(first_line_of_content(text).substr(0, 14));
    std::transform(start.begin(), start.end(), start.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return start.starts_with("<!doctype html") || start.starts_with("<html");
}

bool is_obj_line(std::string_view line) {
    constexpr std::array kKeywords{"v "sv,      "vn "sv, "vt "sv, "f "sv,
                                   "mtllib "sv, "o "sv,  "g "sv,  "usemtl "sv};
    return std::any_of(kKeywords.begin(), kKeywords.end(),
                       [&](std::string_view word) { return line.starts_with(word); });
}

/// Numbers between blanks, commas or semicolons, at least three of them.
bool is_row_of_numbers(std::string_view line) {
    if (line.find_first_not_of("0123456789+-.eE \t,;naNifF") != line.npos) return false;
    int numbers = 0;
    bool inside = false;
    for (const char c : line) {
        const bool separator = c == ' ' || c == '\t' || c == ',' || c == ';';
        numbers += !separator && !inside ? 1 : 0;
        inside = !separator;
    }
    const bool has_digit = line.find_first_of("0123456789") != line.npos;
    return numbers >= 3 && has_digit;
}

}  // namespace

std::string describe_foreign(std::span<const std::byte> bytes) {
    if (bytes.empty()) return "an empty file";
    constexpr std::size_t kLookedAt = 4096;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min(bytes.size(), kLookedAt));
    for (const Signature& signature : kSignatures) {
        if (text.starts_with(signature.bytes)) return std::string(signature.meaning);
    }
    if (is_html(text)) return "an HTML page";
    const std::string_view line = first_line_of_content(text);
    if (line.starts_with("VERSION") && text.find("FIELDS") != text.npos) {
        return "a PCD point cloud";
    }
    if (is_obj_line(line)) return "an OBJ model";
    if (is_row_of_numbers(line)) return "plain rows of numbers (XYZ text)";
    return message_of("something unknown that begins with ", quoted(text.substr(0, 12)));
}

}  // namespace lpf
