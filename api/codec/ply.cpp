#include "api/codec/ply.h"

#include <algorithm>
#include <utility>

#include "api/codec/faces.h"
#include "api/codec/ply_checks.h"
#include "api/codec/ply_columns.h"
#include "api/codec/ply_header.h"
#include "api/codec/text.h"

namespace lpf {
namespace {

bool float32_may_lose(ScalarType type) {
    return type == ScalarType::Float64 || type == ScalarType::Int32 || type == ScalarType::UInt32;
}

void take_vertices(PlyTable table, Document& document, const Execution& execution) {
    PointCloud& cloud = document.shape.cloud;
    cloud.points.resize(3, static_cast<Eigen::Index>(table.rows));
    constexpr std::string_view kAxes = "xyz";
    for (PlyColumn& column : table.columns) {
        throw_if_cancelled(execution);
        const std::string& name = column.property().name;
        const std::size_t axis = name.size() == 1 ? kAxes.find(name[0]) : kAxes.npos;
        if (axis == kAxes.npos) {
            cloud.attributes.push_back(column.release());
            continue;
        }
        fill_coordinate(column, cloud.points, static_cast<Eigen::Index>(axis), execution);
        document.double_positions |= float32_may_lose(column.property().type);
        (void)column.release();  // the bytes are not needed any more
    }
}

void take_faces(PlyColumn& column, Document& document, const DecodeLimits& limits,
                const Execution& execution) {
    const bool triangles_only = column.all_lists_have(3);
    Polygons polygons;
    polygons.vertices = vertex_numbers(column);
    if (!triangles_only) polygons.offsets = column.take_offsets();
    (void)column.release();
    throw_if_cancelled(execution);
    check_vertex_numbers(polygons, 0, document.shape.size());
    throw_if_cancelled(execution);
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

void take_face_table(PlyTable table, Document& document, const DecodeLimits& limits,
                     const Execution& execution) {
    const auto list =
        std::find_if(table.columns.begin(), table.columns.end(),
                     [](const PlyColumn& column) { return is_face_list(column.property()); });
    if (list == table.columns.end()) {
        document.elements.push_back(release_element(std::move(table)));
        return;
    }
    take_faces(*list, document, limits, execution);
    table.columns.erase(list);
    for (PlyColumn& column : table.columns) document.face_attributes.push_back(column.release());
}

/// The part of the bar that the rows of one element fill.
Execution part_for(const Execution& execution, const PlyHeader& header, const PlyElement& element) {
    double before = 0;
    double all = 1;
    for (const PlyElement& other : header.elements) {
        if (&other < &element) before += static_cast<double>(other.count);
        all += static_cast<double>(other.count);
    }
    return part_of(execution, before / all, (before + static_cast<double>(element.count)) / all);
}

}  // namespace

Document decode_ply(std::span<const std::byte> bytes, const DecodeLimits& limits,
                    const Execution& execution) {
    PlyHeader header = parse_ply_header(bytes);
    check_ply_claims(header, bytes.size(), limits);
    (void)ply_vertices(header);

    Document document;
    document.format = header.format;
    document.comments = std::move(header.comments);
    document.obj_info = std::move(header.obj_info);
    PlyPlace place{bytes, header.bytes};
    PlyTable faces;
    for (const PlyElement& element : header.elements) {
        place.row = 0;
        PlyTable table = read_rows(header.format, element, element.count, place,
                                   part_for(execution, header, element));
        if (table.name == "vertex") {
            take_vertices(std::move(table), document, execution);
        } else if (table.name == "face") {
            faces = std::move(table);
        } else {
            document.elements.push_back(release_element(std::move(table)));
        }
    }
    // Faces may stand before the vertices that they refer to, so they come last here.
    if (!faces.columns.empty()) take_face_table(std::move(faces), document, limits, execution);
    drop_non_finite_points(document, execution);
    return document;
}

}  // namespace lpf
