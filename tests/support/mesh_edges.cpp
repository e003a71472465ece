#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/meshes.h"

namespace lpf::test {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// (b - a) x (c - a) of a triangle: its normal, as long as twice its area.
Eigen::Vector3d area_normal(const Shape& mesh, Eigen::Index face) {
    const auto corner = [&](int c) -> Eigen::Vector3d {
        return mesh.cloud.points.col(mesh.triangles(c, face));
    };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0));
}

bool is_sharp(const Shape& mesh, const std::vector<Eigen::Index>& faces, double degrees) {
    if (faces.size() != 2) return false;
    const Eigen::Vector3d a = area_normal(mesh, faces[0]), b = area_normal(mesh, faces[1]);
    return a.dot(b) < std::cos(degrees * std::numbers::pi / 180) * a.norm() * b.norm();
}

/// The edges whose triangles are `wanted`, in the order of their vertices.
template <typename Wanted>
Triangles edges_where(const Shape& mesh, const Wanted& wanted) {
    std::map<Edge, std::vector<Eigen::Index>> faces_at;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        for (int c = 0; c < 3; ++c) {
            faces_at[std::minmax(mesh.triangles(c, f), mesh.triangles((c + 1) % 3, f))].push_back(
                f);
        }
    }
    std::erase_if(faces_at, [&](const auto& edge) { return !wanted(edge.second); });
    Triangles edges(3, static_cast<Eigen::Index>(faces_at.size()));
    Eigen::Index i = 0;
    for (const auto& [edge, faces] : faces_at) {
        edges.col(i++) << edge.first, edge.second, edge.second;
    }
    return edges;
}

}  // namespace

Triangles sharp_edges(const Shape& mesh, double degrees) {
    return edges_where(mesh, [&](const auto& faces) { return is_sharp(mesh, faces, degrees); });
}

Triangles border_edges(const Shape& mesh) {
    return edges_where(mesh, [](const auto& faces) { return faces.size() == 1; });
}

}  // namespace lpf::test
