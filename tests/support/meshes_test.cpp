#include "tests/support/meshes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace lpf::test {
namespace {

struct Measured {
    double area = 0.0;
    double volume = 0.0;  // signed: positive when triangles are turned outwards
    int boundary_edges = 0;
};

Measured measure(const Shape& mesh) {
    Measured result;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const Eigen::Vector3d a = mesh.cloud.points.col(mesh.triangles(0, f));
        const Eigen::Vector3d b = mesh.cloud.points.col(mesh.triangles(1, f));
        const Eigen::Vector3d c = mesh.cloud.points.col(mesh.triangles(2, f));
        result.area += (b - a).cross(c - a).norm() / 2;
        result.volume += a.dot(b.cross(c)) / 6;
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t from = mesh.triangles(i, f), to = mesh.triangles((i + 1) % 3, f);
            ++edges[{from, to}];
            --edges[{to, from}];
        }
    }
    for (const auto& [edge, uses] : edges) result.boundary_edges += uses > 0;
    return result;
}

TEST(CubeMesh, IsClosedAndTurnedOutwards) {
    const Shape cube = cube_mesh(1.5, 3);
    const Measured measured = measure(cube);
    EXPECT_NEAR(measured.area, 54.0, 1e-9);
    EXPECT_NEAR(measured.volume, 27.0, 1e-9);
    EXPECT_EQ(measured.boundary_edges, 0);
    EXPECT_EQ(cube.size(), 56U);
    EXPECT_EQ(cube_mesh().size(), 8U);
    EXPECT_EQ(cube_mesh().triangles.cols(), 12);
}

TEST(Icosphere, IsClosedAndNearlyASphere) {
    const Shape sphere = icosphere(2.0, 4);
    const Measured measured = measure(sphere);
    EXPECT_EQ(sphere.triangles.cols(), 20 * 256);
    EXPECT_EQ(sphere.size(), 2562U);
    EXPECT_EQ(measured.boundary_edges, 0);
    EXPECT_NEAR(measured.area, 16 * std::numbers::pi, 0.2);
    EXPECT_NEAR(measured.volume, 32 * std::numbers::pi / 3, 0.15);
    EXPECT_TRUE((sphere.cloud.points.colwise().norm().array() - 2.0).abs().maxCoeff() < 1e-12);
}

TEST(Globe, HasTheVerticesThatWereAskedFor) {
    const Shape sphere = globe(1.0, 7, 14);
    const Measured measured = measure(sphere);
    EXPECT_EQ(sphere.size(), 100U);
    EXPECT_EQ(sphere.triangles.cols(), 2 * 14 * 7);
    EXPECT_EQ(measured.boundary_edges, 0);
    EXPECT_GT(measured.volume, 0.9 * 4 * std::numbers::pi / 3);
    EXPECT_TRUE((sphere.cloud.points.colwise().norm().array() - 1.0).abs().maxCoeff() < 1e-12);
}

TEST(PyramidMesh, IsEngravedAndOpenBelow) {
    const Shape pyramid = pyramid_mesh();
    const Measured measured = measure(pyramid);
    EXPECT_EQ(measured.boundary_edges, 4);
    const double smooth_area = 2 * 80 * std::hypot(40.0, 54.34);
    EXPECT_GT(measured.area, 1.05 * smooth_area);
    EXPECT_LT(measured.area, 1.3 * smooth_area);
    EXPECT_LT(measured.volume, 80 * 80 * 54.34 / 3);
    EXPECT_GT(measured.volume, 0.95 * 80 * 80 * 54.34 / 3);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(pyramid.cloud.points(2, k), 0.0);
}

TEST(DiskSegmentMesh, IsClosedWithThePapersDiagonal) {
    const Shape body = disk_segment_mesh();
    const Measured measured = measure(body);
    EXPECT_EQ(measured.boundary_edges, 0);
    EXPECT_GT(measured.volume, 1.0);
    const Eigen::Vector3d size =
        body.cloud.points.rowwise().maxCoeff() - body.cloud.points.rowwise().minCoeff();
    EXPECT_NEAR(size.norm(), 7.6156, 0.001);
}

TEST(HeadMesh, IsClosedAndRough) {
    const Shape head = head_mesh();
    const Measured measured = measure(head);
    EXPECT_EQ(measured.boundary_edges, 0);
    const Eigen::Vector3d size =
        head.cloud.points.rowwise().maxCoeff() - head.cloud.points.rowwise().minCoeff();
    EXPECT_NEAR(size.norm(), 51.96, 1e-9);
    // A smooth body of this volume and shape has less area than one with locks.
    EXPECT_GT(measured.area,
              1.05 * std::cbrt(36 * std::numbers::pi * std::pow(measured.volume, 2)));
}

TEST(SharpEdges, OfACubeAreItsTwelve) {
    const Shape cube = cube_mesh(1.0, 2);
    const Triangles edges = sharp_edges(cube);
    EXPECT_EQ(edges.cols(), 24) << "each edge of two cells";
    for (Eigen::Index i = 0; i < edges.cols(); ++i) {
        const Eigen::Vector3d middle =
            (cube.cloud.points.col(edges(0, i)) + cube.cloud.points.col(edges(1, i))) / 2;
        EXPECT_EQ((middle.array().abs() == 1.0).count(), 2) << middle.transpose();
    }
    EXPECT_EQ(sharp_edges(icosphere(1.0, 3)).cols(), 0);
}

TEST(PlaneGrid, IsOpenAndFlat) {
    const Shape grid = plane_grid(2.0, 5);
    const Measured measured = measure(grid);
    EXPECT_EQ(grid.size(), 36U);
    EXPECT_EQ(grid.triangles.cols(), 50);
    EXPECT_NEAR(measured.area, 16.0, 1e-12);
    EXPECT_EQ(measured.boundary_edges, 20);
    EXPECT_TRUE(grid.cloud.points.row(2).isZero());
}

}  // namespace
}  // namespace lpf::test
