#include "tests/support/meshes.h"

#include <cmath>
#include <numbers>

#include "tests/support/mesh_builder.h"

namespace lpf::test {
namespace {

/// A lattice of squares over corner + [0, 1] u + [0, 1] v; normals along u x v.
void add_lattice(MeshBuilder& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& u,
                 const Eigen::Vector3d& v, int cells) {
    const auto node = [&](int i, int j) {
        return mesh.vertex(corner + u * (double(i) / cells) + v * (double(j) / cells));
    };
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            mesh.quadrangle(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
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
    const MeshBuilder::Corners faces[20] = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (const auto& [a, b, c] : faces) mesh.triangle(a, b, c);
    for (int i = 0; i < subdivisions; ++i) subdivide_on_sphere(mesh);
    return mesh.shape(radius);
}

Shape globe(double radius, int rings, int segments) {
    MeshBuilder mesh;
    const auto node = [&](int ring, int segment) {
        const double polar = std::numbers::pi * ring / (rings + 1);
        if (ring == 0 || ring == rings + 1) return mesh.vertex({0, 0, ring == 0 ? 1.0 : -1.0});
        const double angle = 2 * std::numbers::pi * (segment % segments) / segments;
        return mesh.vertex({std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                            std::cos(polar)});
    };
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j < segments; ++j) {
            mesh.quadrangle(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
        }
    }
    return mesh.shape(radius);
}

Shape plane_grid(double half, int cells) {
    MeshBuilder mesh;
    add_lattice(mesh, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, cells);
    return mesh.shape(half);
}

}  // namespace lpf::test
