#include "tests/support/meshes.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace lpf::test {
namespace {

using Corner = std::array<std::uint32_t, 3>;

/// Collects vertices, each place once, and triangles over them.
class MeshBuilder {
public:
    std::uint32_t vertex(const Eigen::Vector3d& at) {
        const std::array<long, 3> key{std::lround(at.x() * 1e9), std::lround(at.y() * 1e9),
                                      std::lround(at.z() * 1e9)};
        const auto [found, added] = known_.try_emplace(key, vertices_.size());
        if (added) vertices_.push_back(at);
        return static_cast<std::uint32_t>(found->second);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        triangles_.push_back({a, b, c});
    }
    const Eigen::Vector3d& at(std::uint32_t i) const { return vertices_[i]; }
    std::vector<Corner> take_triangles() { return std::exchange(triangles_, {}); }

    Shape shape(double scale = 1.0) const {
        Shape result;
        result.cloud.points.resize(3, static_cast<Eigen::Index>(vertices_.size()));
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            result.cloud.points.col(static_cast<Eigen::Index>(i)) = scale * vertices_[i];
        }
        result.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
        for (std::size_t f = 0; f < triangles_.size(); ++f) {
            for (int c = 0; c < 3; ++c) {
                result.triangles(c, static_cast<Eigen::Index>(f)) =
                    triangles_[f][static_cast<std::size_t>(c)];
            }
        }
        return result;
    }

private:
    std::vector<Eigen::Vector3d> vertices_;
    std::vector<Corner> triangles_;
    std::map<std::array<long, 3>, std::size_t> known_;
};

/// A lattice of squares over corner + [0, 1] u + [0, 1] v; normals along u x v.
void add_lattice(MeshBuilder& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                 const Eigen::Vector3d& v, int cells) {
    const auto node = [&](int i, int j) {
        return mesh.vertex(corner + u * (double(i) / cells) + v * (double(j) / cells));
    };
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            mesh.triangle(node(i, j), node(i + 1, j), node(i + 1, j + 1));
            mesh.triangle(node(i, j), node(i + 1, j + 1), node(i, j + 1));
        }
    }
}

void subdivide_on_sphere(MeshBuilder& mesh) {
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        return mesh.vertex((mesh.at(a) + mesh.at(b)).normalized());
    };
    for (const auto& [a, b, c] : mesh.take_triangles()) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        mesh.triangle(a, ab, ca);
        mesh.triangle(ab, b, bc);
        mesh.triangle(ca, bc, c);
        mesh.triangle(ab, bc, ca);
    }
}

}  // namespace

Shape cube_mesh(double half, int cells) {
    MeshBuilder mesh;
    const Eigen::Vector3d low = Eigen::Vector3d::Constant(-1), high = -low;
    const Eigen::Vector3d x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    add_lattice(mesh, low, y, x, cells);
    add_lattice(mesh, low, x, z, cells);
    add_lattice(mesh, low, z, y, cells);
    add_lattice(mesh, high, -x, -y, cells);
    add_lattice(mesh, high, -z, -x, cells);
    add_lattice(mesh, high, -y, -z, cells);
    return mesh.shape(half);
}

Shape icosphere(double radius, int subdivisions) {
    MeshBuilder mesh;
    const double g = std::numbers::phi;
    const double corners[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                   {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                   {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    for (const auto& c : corners) mesh.vertex(Eigen::Vector3d(c[0], c[1], c[2]).normalized());
    const Corner faces[20] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const auto& [a, b, c] : faces) mesh.triangle(a, b, c);
    for (int i = 0; i < subdivisions; ++i) subdivide_on_sphere(mesh);
    return mesh.shape(radius);
}

Shape plane_grid(double half, int cells) {
    MeshBuilder mesh;
    add_lattice(mesh, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, cells);
    return mesh.shape(half);
}

}  // namespace lpf::test
