#include "tests/support/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "tests/support/meshes.h"

namespace lpf::test {
namespace {

Points random_points(Eigen::Index count, std::uint64_t seed) {
    Points points(3, count);
    Random random(seed);
    for (double& value : points.reshaped()) value = random.uniform(-1, 1);
    return points;
}

TEST(Summarize, KnownNumbers) {
    const ErrorStats stats = summarize({4, 3, 0, 0});
    EXPECT_EQ(stats.count, 4U);
    EXPECT_DOUBLE_EQ(stats.mean, 1.75);
    EXPECT_DOUBLE_EQ(stats.rmse, 2.5);
    EXPECT_DOUBLE_EQ(stats.p95, 4.0);
    EXPECT_DOUBLE_EQ(stats.max, 4.0);
}

TEST(Summarize, P95LeavesOneInTwentyAbove) {
    std::vector<double> values;
    for (int i = 1; i <= 100; ++i) values.push_back(i);
    EXPECT_DOUBLE_EQ(summarize(values).p95, 95.0);
}

TEST(Summarize, NothingIsAllZero) { EXPECT_EQ(summarize({}).rmse, 0.0); }

TEST(CloudDistance, AgreesWithBruteForce) {
    const Points cloud = random_points(700, 1), queries = random_points(300, 2);
    const CloudDistance nearest(cloud);
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
        const double brute = (cloud.colwise() - queries.col(i)).colwise().norm().minCoeff();
        ASSERT_DOUBLE_EQ(nearest(queries.col(i)), brute);
    }
}

TEST(CloudDistance, ManyEqualPointsAreNoTrouble) {
    const Points same = Points::Constant(3, 1000, 2.0);
    EXPECT_EQ(CloudDistance(same)({2, 2, 2}), 0.0);
    EXPECT_EQ(CloudDistance(same).to_others({2, 2, 2}, 17), 0.0);
}

TEST(CloudDistance, EmptyCloudIsInfinitelyFar) {
    EXPECT_EQ(CloudDistance(Points(3, 0))({0, 0, 0}), std::numeric_limits<double>::infinity());
}

TEST(TriangleDistance, FaceEdgeAndCorner) {
    const Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
    EXPECT_DOUBLE_EQ(squared_distance_to_triangle({0.25, 0.25, -3}, a, b, c), 9.0);
    EXPECT_DOUBLE_EQ(squared_distance_to_triangle({0.5, -2, 0}, a, b, c), 4.0);
    EXPECT_DOUBLE_EQ(squared_distance_to_triangle({-3, -4, 0}, a, b, c), 25.0);
    EXPECT_DOUBLE_EQ(squared_distance_to_triangle({1, 1, 0}, a, b, c), 0.5);
}

TEST(TriangleDistance, TriangleWithoutAreaIsItsEdges) {
    EXPECT_DOUBLE_EQ(squared_distance_to_triangle({0.5, 2, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}),
                     4.0);
    EXPECT_DOUBLE_EQ(squared_distance_to_triangle({3, 4, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
                     25.0);
}

TEST(MeshDistance, AgreesWithTheExactCube) {
    const Shape mesh = cube_mesh(1.0, 4);
    const MeshDistance distance(mesh.cloud.points, mesh.triangles);
    const TestShape cube = make_cube({.points = 1});
    const Points queries = 2.0 * random_points(500, 4);
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
        ASSERT_NEAR(distance(queries.col(i)), cube.distance(queries.col(i)), 1e-12);
    }
}

TEST(ErrorByPart, PointsCountWhereTheyAreNearest) {
    const TestShape shape = make_cube_with_curve({.points = 1});
    Points points(3, 3);
    points.col(0) << 2.3, 0, 1.5;   // over a face, .5 from an edge
    points.col(1) << 2.3, 0, 2.4;   // over the edge itself: .3 and .4 off
    points.col(2) << 0, 0, 0.5001;  // the wave passes through (0, 0, .5)
    const PartErrors parts = error_by_part(points, shape, 0.55);
    EXPECT_EQ(parts.all.count, 3U);
    EXPECT_EQ(parts.surface.count, 2U);
    EXPECT_NEAR(parts.surface.max, 0.5, 1e-9);
    EXPECT_EQ(parts.curve.count, 1U);
    EXPECT_NEAR(parts.curve.max, 1e-4, 1e-4);
    EXPECT_EQ(parts.near_edges.count, 1U);
    EXPECT_NEAR(parts.near_edges.rmse, 0.5, 1e-9);
    EXPECT_EQ(error_by_part(points, shape, 0.6).near_edges.count, 2U);
}

TEST(ErrorByPart, AllIsTheErrorToTheShape) {
    const TestShape shape = make_curvenet({.points = 5000, .noise = 0.2});
    EXPECT_DOUBLE_EQ(error_by_part(shape.points, shape, 1).all.rmse,
                     error_to_shape(shape.points, shape).rmse);
    EXPECT_EQ(error_by_part(shape.points, shape, 1).near_edges.count, 0U);
}

TEST(Coverage, RoundedEdgesAreSeen) {
    const TestShape cube = make_cube({.points = 40000});
    EXPECT_LT(coverage_of_shape(cube, cube.points).edge, 0.04);
    EXPECT_NEAR(coverage_of_shape(cube, 0.9 * cube.points).edge, 0.1 * std::sqrt(2.0), 0.02);
    EXPECT_TRUE(std::isnan(coverage_of_shape(make_sphere({.points = 1}), cube.points).edge));
}

TEST(Coverage, AHoleIsSeen) {
    const TestShape plane = make_plane({.points = 20000});
    Points half(3, 0);
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < plane.points.cols(); ++i) {
        if (plane.points(0, i) < 0) kept.push_back(i);
    }
    half = plane.points(Eigen::all, kept);
    const double whole = coverage_of_shape(plane, plane.points).surface;
    EXPECT_LT(whole, 0.02);
    // Half of the samples are x away from the rest, x uniform in [0, 1]: RMS sqrt(1/6).
    EXPECT_NEAR(coverage_of_shape(plane, half).surface, std::sqrt(1.0 / 6.0), 0.01);
    EXPECT_TRUE(std::isnan(coverage_of_shape(plane, half).curve));
    EXPECT_GT(coverage_of_shape(plane, half).border, 0.3);
}

TEST(NeighbourStats, LatticeHasOneDistance) {
    const Shape grid = plane_grid(1.0, 20);
    const NeighbourStats stats = nearest_neighbour_stats(grid.cloud.points);
    EXPECT_NEAR(stats.mean, 0.1, 1e-12);
    EXPECT_NEAR(stats.deviation, 0.0, 1e-7);
    EXPECT_NEAR(stats.min, stats.max, 1e-12);
}

TEST(NeighbourStats, UniformSamplesHaveTheTheoreticalMean) {
    const TestShape plane = make_plane({.points = 40000});
    // 1 / (2 sqrt(density)) for a Poisson process in the plane; the border adds a little.
    EXPECT_NEAR(nearest_neighbour_stats(plane.points).mean, 0.5 / std::sqrt(10000.0), 0.0001);
}

TEST(Displacement, IsRowByRow) {
    Points before = Points::Zero(3, 2), after = before;
    after(0, 1) = 2;
    EXPECT_DOUBLE_EQ(displacement(before, after).max, 2.0);
    EXPECT_DOUBLE_EQ(displacement(before, after).mean, 1.0);
}

TEST(DiagonalOf, BoxOfThePoints) {
    Points points = Points::Zero(3, 2);
    points.col(1) << 1, 2, 2;
    EXPECT_DOUBLE_EQ(diagonal_of(points), 3.0);
    EXPECT_EQ(diagonal_of(Points(3, 0)), 0.0);
}

}  // namespace
}  // namespace lpf::test
