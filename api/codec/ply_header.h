#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/document.h"

namespace lpf {

struct PlyProperty {
    std::string name;
    ScalarType type = ScalarType::Float32;
    bool is_list = false;
    ScalarType count_type = ScalarType::UInt8;  ///< of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;  ///< a claim of the file
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    FileFormat format = FileFormat::PlyAscii;
    std::vector<PlyElement> elements;
    std::vector<std::string> comments;
    std::vector<std::string> obj_info;
    std::size_t bytes = 0;  ///< where the data begins
};

inline constexpr std::size_t kMaxPlyHeaderBytes = 65536;
inline constexpr std::size_t kMaxPlyElements = 16;
inline constexpr std::size_t kMaxPlyProperties = 256;
inline constexpr std::uint64_t kMaxPlyListLength = 65536;

/// Reads everything up to `end_header` and believes no count.
/// @throws Error{MalformedFile} with the line; Error{LimitExceeded}
[[nodiscard]] PlyHeader parse_ply_header(std::span<const std::byte> bytes);

/// The text that says so, to the end of `end_header`. @pre names are single words
[[nodiscard]] std::string ply_header_text(const PlyHeader& header);

/// The short, oldest name of a type ("uchar", "float"), which every reader knows.
[[nodiscard]] std::string_view ply_type_name(ScalarType type);

}  // namespace lpf
