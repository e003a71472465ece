#include "api/codec/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "api/codec/names.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

using Tokens = std::vector<std::string_view>;

constexpr std::array<std::pair<std::string_view, ScalarType>, 16> kTypes{{
    {"char", ScalarType::Int8},
    {"uchar", ScalarType::UInt8},
    {"short", ScalarType::Int16},
    {"ushort", ScalarType::UInt16},
    {"int", ScalarType::Int32},
    {"uint", ScalarType::UInt32},
    {"float", ScalarType::Float32},
    {"double", ScalarType::Float64},
    {"int8", ScalarType::Int8},
    {"uint8", ScalarType::UInt8},
    {"int16", ScalarType::Int16},
    {"uint16", ScalarType::UInt16},
    {"int32", ScalarType::Int32},
    {"uint32", ScalarType::UInt32},
    {"float32", ScalarType::Float32},
    {"float64", ScalarType::Float64},
}};

Tokens split(std::string_view line) {
    Tokens tokens;
    std::size_t at = 0;
    while ((at = line.find_first_not_of(" \t", at)) != std::string_view::npos) {
        const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
        tokens.push_back(line.substr(at, end - at));
        at = end;
    }
    return tokens;
}

/// What follows the keyword of a comment, without the one blank between them.
std::string text_after_keyword(std::string_view line) {
    line.remove_prefix(line.find_first_not_of(" \t"));
    line.remove_prefix(std::min(line.find_first_of(" \t"), line.size()));
    if (!line.empty()) line.remove_prefix(1);
    return std::string(line);
}

class HeaderParser {
public:
    explicit HeaderParser(std::span<const std::byte> bytes)
        : bytes_(bytes.size()),
          text_(reinterpret_cast<const char*>(bytes.data()),
                std::min(bytes.size(), kMaxPlyHeaderBytes)) {}

    PlyHeader parse() {
        parse_magic();
        while (parse_line()) {
        }
        if (!has_format_) malformed("PLY header has no 'format' line");
        for (const PlyElement& element : header_.elements) check_not_empty(element);
        header_.bytes = at_;
        return std::move(header_);
    }

private:
    std::string_view next_line();
    void parse_magic();
    bool parse_line();
    void parse_format(const Tokens& tokens);
    void parse_element(const Tokens& tokens);
    void parse_property(const Tokens& tokens);
    [[nodiscard]] PlyProperty read_property(const Tokens& tokens) const;
    [[nodiscard]] ScalarType type_named(std::string_view name) const;
    static void check_not_empty(const PlyElement& element);
    [[noreturn]] void fail_at_end() const;

    template <typename... Parts>
    [[noreturn]] void wrong(const Parts&... parts) const {
        malformed("PLY header line ", line_, ": ", parts...);
    }

    std::size_t bytes_;
    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
    bool old_mac_lines_ = false;  ///< the first line ended in a CR alone
    bool has_format_ = false;
    PlyHeader header_;
};

void HeaderParser::fail_at_end() const {
    if (bytes_ > kMaxPlyHeaderBytes) {
        fail(ErrorCode::LimitExceeded, "PLY header is longer than ", kMaxPlyHeaderBytes,
             " bytes, the limit; 'end_header' must come before");
    }
    malformed("PLY header: the file ends after line ", line_, " without 'end_header'");
}

/// The next line without its end: LF, CR LF or CR. Where CR alone ends the lines, an LF behind
/// `end_header` is the first byte of the data.
std::string_view HeaderParser::next_line() {
    if (at_ >= text_.size()) fail_at_end();
    const std::size_t end = text_.find_first_of("\r\n", at_);
    if (end == std::string_view::npos && bytes_ > text_.size()) fail_at_end();
    const std::string_view line = text_.substr(at_, end - at_);
    ++line_;
    at_ = std::min(end, text_.size());
    const bool is_cr = at_ < text_.size() && text_[at_] == '\r';
    if (at_ < text_.size()) ++at_;
    const bool lf_follows = is_cr && at_ < text_.size() && text_[at_] == '\n';
    if (line_ == 1) old_mac_lines_ = is_cr && !lf_follows;
    if (lf_follows && !(old_mac_lines_ && line.find("end_header") != line.npos)) ++at_;
    if (line.find('\0') != line.npos) wrong("it holds a NUL byte; a header is plain text");
    return line;
}

void HeaderParser::parse_magic() {
    const std::string_view line = next_line();
    const Tokens tokens = split(line);
    if (tokens.size() != 1 || tokens[0] != "ply" || line.front() != 'p') {
        wrong("it is ", quoted(line), ", but the first line must be 'ply' and nothing else");
    }
}

bool HeaderParser::parse_line() {
    const std::string_view line = next_line();
    const Tokens tokens = split(line);
    if (tokens.empty()) wrong("it is empty; remove it or write 'comment'");
    const std::string_view keyword = tokens[0];
    if (keyword == "comment") {
        header_.comments.push_back(text_after_keyword(line));
    } else if (keyword == "obj_info") {
        header_.obj_info.push_back(text_after_keyword(line));
    } else if (keyword == "format") {
        parse_format(tokens);
    } else if (!has_format_) {
        wrong("found ", quoted(keyword),
              " before 'format'; the second line must be like "
              "'format binary_little_endian 1.0'");
    } else if (keyword == "element") {
        parse_element(tokens);
    } else if (keyword == "property") {
        parse_property(tokens);
    } else if (keyword == "end_header") {
        if (tokens.size() > 1) wrong(quoted(tokens[1]), " stands behind 'end_header'");
        return false;
    } else {
        wrong("unknown keyword ", quoted(keyword),
              "; known are format, comment, obj_info, element, property, end_header");
    }
    return true;
}

void HeaderParser::parse_format(const Tokens& tokens) {
    if (has_format_) wrong("a second 'format' line");
    if (tokens.size() != 3) wrong("'format' needs a kind and a version, like 'format ascii 1.0'");
    if (tokens[1] == "ascii") {
        header_.format = FileFormat::PlyAscii;
    } else if (tokens[1] == "binary_little_endian") {
        header_.format = FileFormat::PlyBinary;
    } else if (tokens[1] == "binary_big_endian") {
        header_.format = FileFormat::PlyBigEndian;
    } else {
        wrong("unknown format ", quoted(tokens[1]),
              "; known are ascii, binary_little_endian, binary_big_endian");
    }
    if (tokens[2] != "1.0") wrong("version ", quoted(tokens[2]), " is not known; it must be 1.0");
    has_format_ = true;
}

void HeaderParser::parse_element(const Tokens& tokens) {
    if (tokens.size() != 3) wrong("'element' needs a name and a count, like 'element vertex 8'");
    const std::string_view count = tokens[2];
    PlyElement element{std::string(tokens[1]), 0, {}};
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size()) {
        wrong("count ", quoted(count), " of element ", quoted(element.name),
              " is not a whole number from 0 to 2^64 - 1");
    }
    for (const PlyElement& other : header_.elements) {
        if (other.name == element.name) wrong("a second element ", quoted(element.name));
    }
    if (header_.elements.size() == kMaxPlyElements) {
        fail(ErrorCode::LimitExceeded, "PLY header line ", line_, ": more than ", kMaxPlyElements,
             " elements, the limit");
    }
    header_.elements.push_back(std::move(element));
}

void HeaderParser::parse_property(const Tokens& tokens) {
    if (header_.elements.empty()) wrong("a 'property' before the first 'element'");
    PlyElement& element = header_.elements.back();
    PlyProperty property = read_property(tokens);
    for (const PlyProperty& other : element.properties) {
        if (other.name == property.name) {
            wrong("a second property ", quoted(property.name), " in element ",
                  quoted(element.name));
        }
    }
    if (element.properties.size() == kMaxPlyProperties) {
        fail(ErrorCode::LimitExceeded, "PLY header line ", line_, ": more than ", kMaxPlyProperties,
             " properties, the limit, in element ", quoted(element.name));
    }
    element.properties.push_back(std::move(property));
}

PlyProperty HeaderParser::read_property(const Tokens& tokens) const {
    const bool is_list = tokens.size() > 1 && tokens[1] == "list";
    if (!is_list) {
        if (tokens.size() != 3) {
            wrong("'property' needs one type and one name, like 'property float x'");
        }
        return {std::string(tokens[2]), type_named(tokens[1]), false, ScalarType::UInt8};
    }
    if (tokens.size() != 5) {
        wrong(
            "a list property needs two types and one name, like "
            "'property list uchar int vertex_indices'");
    }
    const ScalarType count_type = type_named(tokens[2]);
    if (count_type == ScalarType::Float32 || count_type == ScalarType::Float64) {
        wrong("a list cannot be counted in ", quoted(tokens[2]), "; use uchar, ushort or uint");
    }
    return {std::string(tokens[4]), type_named(tokens[3]), true, count_type};
}

ScalarType HeaderParser::type_named(std::string_view name) const {
    for (const auto& [known, type] : kTypes) {
        if (known == name) return type;
    }
    wrong("unknown type ", quoted(name),
          "; known are char uchar short ushort int uint float "
          "double and int8 uint8 int16 uint16 int32 uint32 float32 float64");
}

void HeaderParser::check_not_empty(const PlyElement& element) {
    if (element.properties.empty() && element.count > 0) {
        malformed("PLY header: element ", quoted(element.name), " has ", element.count,
                  " rows, but no property");
    }
}

std::string_view kind_of(FileFormat format) {
    switch (format) {
        case FileFormat::PlyAscii: return "ascii";
        case FileFormat::PlyBigEndian: return "binary_big_endian";
        default: return "binary_little_endian";
    }
}

void append_lines(std::string_view keyword, const std::vector<std::string>& lines,
                  std::string& out) {
    for (const std::string& line : lines) {
        out += message_of(keyword, line.empty() ? "" : " ", one_line(line), "\n");
    }
}

}  // namespace

PlyHeader parse_ply_header(std::span<const std::byte> bytes) { return HeaderParser(bytes).parse(); }

std::string ply_header_text(const PlyHeader& header) {
    std::string out = message_of("ply\nformat ", kind_of(header.format), " 1.0\n");
    append_lines("comment", header.comments, out);
    append_lines("obj_info", header.obj_info, out);
    for (const PlyElement& element : header.elements) {
        out += message_of("element ", element.name, " ", element.count, "\n");
        for (const PlyProperty& property : element.properties) {
            out += "property ";
            if (property.is_list) {
                out += message_of("list ", ply_type_name(property.count_type), " ");
            }
            out += message_of(ply_type_name(property.type), " ", property.name, "\n");
        }
    }
    return out + "end_header\n";
}

std::string_view ply_type_name(ScalarType type) {
    for (const auto& [name, known] : kTypes) {
        if (known == type) return name;
    }
    return "float";
}

}  // namespace lpf
