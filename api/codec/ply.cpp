#include "api/codec/ply.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "api/codec/faces.h"
#include "api/codec/ply_columns.h"
#include "api/codec/ply_header.h"
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

/// Compares what the header promises with the bytes there are, before memory is taken for it.
void check_claims(const PlyHeader& header, std::size_t file_bytes, const DecodeLimits& limits) {
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

const PlyProperty* find_property(const PlyElement& element, std::string_view name) {
    for (const PlyProperty& property : element.properties) {
        if (property.name == name) return &property;
    }
    return nullptr;
}

void check_vertex_element(const PlyHeader& header) {
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
}

template <typename T>
void fill_coordinate(const std::vector<std::byte>& data, Points& points, Eigen::Index axis) {
    const std::byte* source = data.data();
    for (Eigen::Index i = 0; i < points.cols(); ++i, source += sizeof(T)) {
        T value;
        std::memcpy(&value, source, sizeof value);
        points(axis, i) = static_cast<double>(value);
    }
}

void fill_coordinate(const PlyColumn& column, Points& points, Eigen::Index axis) {
    switch (column.property().type) {
        case ScalarType::Int8: return fill_coordinate<std::int8_t>(column.data(), points, axis);
        case ScalarType::UInt8: return fill_coordinate<std::uint8_t>(column.data(), points, axis);
        case ScalarType::Int16: return fill_coordinate<std::int16_t>(column.data(), points, axis);
        case ScalarType::UInt16: return fill_coordinate<std::uint16_t>(column.data(), points, axis);
        case ScalarType::Int32: return fill_coordinate<std::int32_t>(column.data(), points, axis);
        case ScalarType::UInt32: return fill_coordinate<std::uint32_t>(column.data(), points, axis);
        case ScalarType::Float32: return fill_coordinate<float>(column.data(), points, axis);
        case ScalarType::Float64: return fill_coordinate<double>(column.data(), points, axis);
    }
}

bool float32_may_lose(ScalarType type) {
    return type == ScalarType::Float64 || type == ScalarType::Int32 || type == ScalarType::UInt32;
}

void take_vertices(PlyTable table, Document& document) {
    PointCloud& cloud = document.shape.cloud;
    cloud.points.resize(3, static_cast<Eigen::Index>(table.rows));
    constexpr std::string_view kAxes = "xyz";
    for (PlyColumn& column : table.columns) {
        const std::string& name = column.property().name;
        const std::size_t axis = name.size() == 1 ? kAxes.find(name[0]) : kAxes.npos;
        if (axis == kAxes.npos) {
            cloud.attributes.push_back(column.release());
            continue;
        }
        fill_coordinate(column, cloud.points, static_cast<Eigen::Index>(axis));
        document.double_positions |= float32_may_lose(column.property().type);
        (void)column.release();  // the bytes are not needed any more
    }
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

std::vector<std::uint32_t> indices_of(const PlyColumn& column) {
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

bool is_face_list(const PlyColumn& column) {
    const PlyProperty& property = column.property();
    return property.is_list &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
}

void check_indices(const Polygons& polygons, std::size_t points) {
    for (std::size_t i = 0; i < polygons.vertices.size(); ++i) {
        if (polygons.vertices[i] < points) continue;
        const bool same_length = polygons.empty();
        const auto after = std::upper_bound(polygons.offsets.begin(), polygons.offsets.end(), i);
        const std::size_t face =
            same_length ? i / 3 : static_cast<std::size_t>(after - polygons.offsets.begin()) - 1;
        malformed("face ", face, " refers to vertex ",
                  static_cast<std::int32_t>(polygons.vertices[i]), ", but there are ", points,
                  " vertices, counted from 0");
    }
}

void take_faces(PlyColumn& column, Document& document, const DecodeLimits& limits) {
    const bool triangles_only = column.all_lists_have(3);
    Polygons polygons;
    polygons.vertices = indices_of(column);
    if (!triangles_only) polygons.offsets = column.take_offsets();
    (void)column.release();
    check_indices(polygons, document.shape.size());
    if (triangles_only) {
        const auto count = static_cast<Eigen::Index>(polygons.vertices.size() / 3);
        document.shape.triangles = Eigen::Map<const Triangles>(polygons.vertices.data(), 3, count);
        return;
    }
    document.shape.triangles = fans_of(polygons, limits.max_faces);
    document.polygons = std::move(polygons);
}

Element release_element(PlyTable table) {
    Element element{table.name, table.rows, {}};
    for (PlyColumn& column : table.columns) element.attributes.push_back(column.release());
    return element;
}

void take_face_table(PlyTable table, Document& document, const DecodeLimits& limits) {
    const auto list = std::find_if(table.columns.begin(), table.columns.end(), is_face_list);
    if (list == table.columns.end()) {
        document.elements.push_back(release_element(std::move(table)));
        return;
    }
    take_faces(*list, document, limits);
    table.columns.erase(list);
    for (PlyColumn& column : table.columns) document.face_attributes.push_back(column.release());
}

}  // namespace

Document decode_ply(std::span<const std::byte> bytes, const DecodeLimits& limits) {
    PlyHeader header = parse_ply_header(bytes);
    check_claims(header, bytes.size(), limits);
    check_vertex_element(header);

    Document document;
    document.format = header.format;
    document.comments = std::move(header.comments);
    document.obj_info = std::move(header.obj_info);
    std::size_t at = header.bytes;
    PlyTable faces;
    for (const PlyElement& element : header.elements) {
        PlyTable table =
            header.format == FileFormat::PlyAscii
                ? read_ascii_rows(element, bytes, at)
                : read_binary_rows(element, bytes, at, header.format == FileFormat::PlyBigEndian);
        if (table.name == "vertex") {
            take_vertices(std::move(table), document);
        } else if (table.name == "face") {
            faces = std::move(table);
        } else {
            document.elements.push_back(release_element(std::move(table)));
        }
    }
    // Faces may stand before the vertices that they refer to, so they come last here.
    if (!faces.columns.empty()) take_face_table(std::move(faces), document, limits);
    drop_non_finite_points(document);
    return document;
}

}  // namespace lpf
