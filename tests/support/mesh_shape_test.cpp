#include "tests/support/mesh_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/meshes.h"
#include "tests/support/metrics.h"

namespace lpf::test {
namespace {

double total_measure(const std::vector<PiecePtr>& pieces) {
    double sum = 0.0;
    for (const PiecePtr& piece : pieces) sum += piece->measure();
    return sum;
}

TEST(MeshShape, CubeHasItsAreaItsEdgesAndNoBorder) {
    const TestShape cube = make_mesh_shape(cube_mesh(1.0, 4), {.points = 1});
    EXPECT_NEAR(total_measure(cube.pieces), 24.0, 1e-9);
    EXPECT_NEAR(total_measure(cube.edges), 24.0, 1e-9);  // twelve of length 2
    EXPECT_TRUE(cube.borders.empty());
    EXPECT_NEAR(cube.diagonal(), 2 * std::sqrt(3.0), 1e-9);
}

TEST(MeshShape, GridHasABorderAndNoEdges) {
    const TestShape grid = make_mesh_shape(plane_grid(1.0, 5), {.points = 1});
    EXPECT_NEAR(total_measure(grid.borders), 8.0, 1e-9);
    EXPECT_TRUE(grid.edges.empty());
}

TEST(MeshShape, FineSphereIsSmooth) {
    EXPECT_TRUE(make_mesh_shape(icosphere(1.0, 3), {.points = 1}).edges.empty());
    EXPECT_FALSE(make_mesh_shape(icosphere(1.0, 0), {.points = 1}).edges.empty());
}

TEST(MeshShape, SamplesLieOnItUniformByArea) {
    const TestShape cube = make_mesh_shape(cube_mesh(1.0, 1), {.points = 60000});
    EXPECT_LT(error_to_shape(cube.clean, make_cube({.points = 1})).max, 1e-9);
    EXPECT_NEAR(static_cast<double>((cube.clean.row(0).array() > 1 - 1e-9).count()), 10000, 500);
    EXPECT_NEAR(static_cast<double>((cube.clean.row(0).array() > 0).count()), 30000, 700);
}

TEST(MeshShape, MeasuresAsTheExactShapeDoes) {
    const TestShape exact = make_cube({.points = 5000, .noise = 0.05});
    const TestShape mesh = make_mesh_shape(cube_mesh(1.0, 3), {.points = 1});
    const PartErrors expected = error_by_part(exact.points, exact, 0.1);
    const PartErrors measured = error_by_part(exact.points, mesh, 0.1);
    EXPECT_NEAR(measured.all.rmse, expected.all.rmse, 1e-12);
    EXPECT_EQ(measured.near_edges.count, expected.near_edges.count);
    EXPECT_NEAR(measured.near_edges.rmse, expected.near_edges.rmse, 1e-12);
}

}  // namespace
}  // namespace lpf::test
