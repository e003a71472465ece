#include "api/codec/ply_checks.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "api/codec/text.h"

namespace lpf {
namespace {

/// Bytes that one row takes at least: lists empty, ASCII values one digit and one separator.
std::uint64_t least_row_bytes(const PlyElement& element, bool ascii) {
    if (ascii) return 2 * element.properties.size();
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
        bytes += size_of(property.is_list ? property.count_type : property.type);
    }
    return bytes;
}

void check_limit(const PlyElement& element, std::string_view name, std::uint64_t limit) {
    if (element.name == name && element.count > limit) {
        fail(ErrorCode::LimitExceeded, "the file has ", element.count, " rows of element ",
             quoted(element.name), "; the limit is ", limit);
    }
}

const PlyProperty* find_property(const PlyElement& element, std::string_view name) {
    for (const PlyProperty& property : element.properties) {
        if (property.name == name) return &property;
    }
    return nullptr;
}

template <typename T>
std::vector<std::uint32_t> indices_of(const std::vector<std::byte>& data) {
    std::vector<std::uint32_t> indices(data.size() / sizeof(T));
    for (std::size_t i = 0; i < indices.size(); ++i) {
        T value;
        std::memcpy(&value, data.data() + i * sizeof value, sizeof value);
        const auto wide = static_cast<std::int64_t>(value);
        // A negative index becomes one that is out of every range.
        indices[i] =
            wide < 0 ? std::numeric_limits<std::uint32_t>::max() : static_cast<std::uint32_t>(wide);
    }
    return indices;
}

}  // namespace

void check_ply_claims(const PlyHeader& header, std::size_t file_bytes, const DecodeLimits& limits) {
    const bool ascii = header.format == FileFormat::PlyAscii;
    // The last row of an ASCII file needs no separator behind it.
    std::uint64_t left = file_bytes - header.bytes + (ascii ? 1 : 0);
    for (const PlyElement& element : header.elements) {
        const std::uint64_t row = least_row_bytes(element, ascii);
        if (row > 0 && element.count > left / row) {
            malformed("element ", quoted(element.name), " promises ", element.count,
                      " rows of at least ", row, " bytes, but only ", file_bytes - header.bytes,
                      " bytes follow the header (byte ", header.bytes,
                      "); the file is truncated or its count is wrong");
        }
        left -= element.count * row;
    }
    for (const PlyElement& element : header.elements) {
        check_limit(element, "vertex", limits.max_points);
        check_limit(element, "face", limits.max_faces);
    }
}

const PlyElement& ply_vertices(const PlyHeader& header) {
    const auto vertex =
        std::find_if(header.elements.begin(), header.elements.end(),
                     [](const PlyElement& element) { return element.name == "vertex"; });
    if (vertex == header.elements.end()) {
        malformed("the PLY header has no element 'vertex', which would hold the points");
    }
    for (const std::string_view name : {"x", "y", "z"}) {
        const PlyProperty* property = find_property(*vertex, name);
        if (property == nullptr) {
            malformed("element 'vertex' has no property ", quoted(name), "; x, y and z are needed");
        }
        if (property->is_list) {
            malformed("property ", quoted(name),
                      " of element 'vertex' is a list; it must be one "
                      "number");
        }
    }
    return *vertex;
}

bool is_face_list(const PlyProperty& property) {
    return property.is_list &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

std::vector<std::uint32_t> vertex_numbers(const PlyColumn& column) {
    switch (column.property().type) {
        case ScalarType::Int8: return indices_of<std::int8_t>(column.data());
        case ScalarType::UInt8: return indices_of<std::uint8_t>(column.data());
        case ScalarType::Int16: return indices_of<std::int16_t>(column.data());
        case ScalarType::UInt16: return indices_of<std::uint16_t>(column.data());
        case ScalarType::Int32: return indices_of<std::int32_t>(column.data());
        case ScalarType::UInt32: return indices_of<std::uint32_t>(column.data());
        default:
            malformed("property ", quoted(column.property().name), " of element 'face' holds ",
                      ply_type_name(column.property().type),
                      " values; vertex numbers must be whole numbers");
    }
}

void check_vertex_numbers(const Polygons& polygons, std::size_t first_face, std::size_t points) {
    for (std::size_t i = 0; i < polygons.vertices.size(); ++i) {
        if (polygons.vertices[i] < points) continue;
        const bool same_length = polygons.empty();
        const auto after = std::upper_bound(polygons.offsets.begin(), polygons.offsets.end(), i);
        const std::size_t face =
            same_length ? i / 3 : static_cast<std::size_t>(after - polygons.offsets.begin()) - 1;
        malformed("face ", first_face + face, " refers to vertex ",
                  static_cast<std::int32_t>(polygons.vertices[i]), ", but there are ", points,
                  " vertices, counted from 0");
    }
}

}  // namespace lpf
