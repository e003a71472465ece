#include "api/codec/faces.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "api/codec/text.h"

namespace lpf {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

std::vector<std::uint32_t> finite_points(const Points& points) {
    std::vector<std::uint32_t> kept;
    kept.reserve(static_cast<std::size_t>(points.cols()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (points.col(i).allFinite()) kept.push_back(static_cast<std::uint32_t>(i));
    }
    return kept;
}

void keep_points(PointCloud& cloud, const std::vector<std::uint32_t>& kept,
                 const Execution& execution) {
    for (std::size_t i = 0; i < kept.size(); ++i) {
        cloud.points.col(static_cast<Eigen::Index>(i)) = cloud.points.col(kept[i]).eval();
    }
    cloud.points.conservativeResize(3, static_cast<Eigen::Index>(kept.size()));
    for (Attribute& attribute : cloud.attributes) {
        throw_if_cancelled(execution);
        attribute = gather(attribute, kept);
    }
}

/// Renumbers the vertices; returns the faces that lost none.
std::vector<std::uint32_t> renumber_triangles(Triangles& triangles,
                                              const std::vector<std::uint32_t>& new_number) {
    std::vector<std::uint32_t> kept;
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
        const Eigen::Matrix<std::uint32_t, 3, 1> face =
            triangles.col(f).unaryExpr([&](std::uint32_t vertex) { return new_number[vertex]; });
        if ((face.array() == kDropped).any()) continue;
        triangles.col(static_cast<Eigen::Index>(kept.size())) = face;
        kept.push_back(static_cast<std::uint32_t>(f));
    }
    triangles.conservativeResize(3, static_cast<Eigen::Index>(kept.size()));
    return kept;
}

std::vector<std::uint32_t> renumber_polygons(Polygons& polygons,
                                             const std::vector<std::uint32_t>& new_number) {
    std::vector<std::uint32_t> kept;
    Polygons result{{0}, {}};
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        const std::size_t begin = result.vertices.size();
        for (std::uint64_t i = polygons.offsets[f]; i < polygons.offsets[f + 1]; ++i) {
            result.vertices.push_back(new_number[polygons.vertices[i]]);
        }
        const auto first = result.vertices.begin() + static_cast<std::ptrdiff_t>(begin);
        if (std::find(first, result.vertices.end(), kDropped) != result.vertices.end()) {
            result.vertices.resize(begin);
            continue;
        }
        result.offsets.push_back(result.vertices.size());
        kept.push_back(static_cast<std::uint32_t>(f));
    }
    polygons = std::move(result);
    return kept;
}

/// The faces that were no triangles may be among those that were lost.
bool only_triangles(const Polygons& polygons) {
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        if (polygons.offsets[f + 1] - polygons.offsets[f] != 3) return false;
    }
    return true;
}

void keep_faces(Document& document, const std::vector<std::uint32_t>& new_number) {
    const std::size_t before = document.face_count();
    std::vector<std::uint32_t> kept;
    if (document.polygons.empty()) {
        kept = renumber_triangles(document.shape.triangles, new_number);
    } else {
        kept = renumber_polygons(document.polygons, new_number);
        document.shape.triangles = fans_of(document.polygons, kDropped);
        if (only_triangles(document.polygons)) document.polygons = {};
    }
    if (kept.size() == before) return;
    for (Attribute& attribute : document.face_attributes) attribute = gather(attribute, kept);
    document.warnings.push_back({"faces-dropped", message_of(before - kept.size(), " of ", before,
                                                             " faces used a dropped point")});
}

void drop_elements_with_point_numbers(Document& document) {
    std::erase_if(document.elements, [&](const Element& element) {
        if (!refers_to_points(element)) return false;
        document.warnings.push_back(
            {"element-dropped", message_of("element ", quoted(element.name),
                                           " refers to points by numbers that changed")});
        return true;
    });
}

}  // namespace

void check_triangle_count(std::uint64_t count, std::uint64_t max_faces) {
    if (count <= max_faces) return;
    fail(ErrorCode::LimitExceeded, "the polygons make ", count, " triangles; the limit is ",
         max_faces);
}

Warning dropped_points_warning(std::uint64_t dropped, std::uint64_t all) {
    if (dropped == all) {
        malformed("all ", all,
                  " points have a NaN or infinite coordinate; at least one must be finite");
    }
    return {"non-finite-points-dropped",
            message_of(dropped, " of ", all,
                       " points have a NaN or infinite coordinate and were left out")};
}

Triangles fans_of(const Polygons& polygons, std::uint64_t max_faces) {
    std::uint64_t count = 0;
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        const std::uint64_t corners = polygons.offsets[f + 1] - polygons.offsets[f];
        if (corners > 2) count += corners - 2;
    }
    check_triangle_count(count, max_faces);
    Triangles triangles(3, static_cast<Eigen::Index>(count));
    Eigen::Index next = 0;
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        const std::uint64_t first = polygons.offsets[f];
        for (std::uint64_t i = first + 2; i < polygons.offsets[f + 1]; ++i) {
            triangles.col(next++) << polygons.vertices[first], polygons.vertices[i - 1],
                polygons.vertices[i];
        }
    }
    return triangles;
}

void drop_non_finite_points(Document& document, const Execution& execution) {
    const std::size_t before = document.shape.size();
    if (document.shape.cloud.points.allFinite()) return;
    const std::vector<std::uint32_t> kept = finite_points(document.shape.cloud.points);
    const Warning warning = dropped_points_warning(before - kept.size(), before);
    std::vector<std::uint32_t> new_number(before, kDropped);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        new_number[kept[i]] = static_cast<std::uint32_t>(i);
    }
    document.dropped_points = before - kept.size();
    document.warnings.push_back(warning);
    throw_if_cancelled(execution);
    keep_points(document.shape.cloud, kept, execution);
    throw_if_cancelled(execution);
    keep_faces(document, new_number);
    drop_elements_with_point_numbers(document);
}

bool refers_to_points(const Element& element) {
    constexpr std::array<std::string_view, 8> kNames{"vertex_index", "vertex_indices", "vertex1",
                                                     "vertex2",      "vertex_1",       "vertex_2",
                                                     "vertex_id",    "vertex_ids"};
    return std::any_of(
        element.attributes.begin(), element.attributes.end(), [&](const Attribute& attribute) {
            return std::find(kNames.begin(), kNames.end(), attribute.name) != kNames.end();
        });
}

}  // namespace lpf
