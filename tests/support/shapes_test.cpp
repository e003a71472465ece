#include "tests/support/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "tests/support/meshes.h"
#include "tests/support/metrics.h"

namespace lpf::test {
namespace {

class EveryShape : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(shape_names()),
                         [](const auto& tested) { return tested.param; });

TEST_P(EveryShape, CleanSamplesLieOnIt) {
    const TestShape shape = make_shape(GetParam(), {.points = 3000});
    for (Eigen::Index i = 0; i < shape.clean.cols(); ++i) {
        if (!shape.outlier.empty() && shape.outlier[static_cast<std::size_t>(i)]) continue;
        ASSERT_NEAR(shape.distance(shape.clean.col(i)), 0.0, 1e-7) << "point " << i;
    }
}

TEST_P(EveryShape, DistanceIsThatOfTheNearestDenseSample) {
    const TestShape shape = make_shape(GetParam(), {.points = 2});
    const Points dense = sample_pieces(shape.pieces, 200000, 5, 0.5);
    const CloudDistance nearest(dense);
    const double offset = 0.02 * shape.diagonal();
    const double largest_hole = 0.012 * shape.diagonal();  // about five mean spacings
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Vector3d near = dense.col(static_cast<Eigen::Index>(random.below(200000)));
        const Vector3d query =
            near + offset * Vector3d(random.normal(), random.normal(), random.normal());
        const double exact = shape.distance(query);
        const double sampled = nearest(query);
        ASSERT_LE(exact, sampled + 1e-9);
        ASSERT_LT(sampled, exact + largest_hole) << "query " << query.transpose();
    }
}

TEST_P(EveryShape, SameSeedGivesTheSamePoints) {
    const Sampling sampling{.points = 500, .noise = 0.01, .seed = 9};
    EXPECT_EQ(make_shape(GetParam(), sampling).points, make_shape(GetParam(), sampling).points);
    const TestShape other = make_shape(GetParam(), {.points = 500, .noise = 0.01, .seed = 10});
    EXPECT_NE(make_shape(GetParam(), sampling).points, other.points);
}

TEST_P(EveryShape, NoiseHasTheDeviationAskedFor) {
    const TestShape shape = make_shape(GetParam(), {.points = 4000, .noise = 0.05});
    double squares = 0.0;
    std::size_t used = 0;
    for (Eigen::Index i = 0; i < shape.points.cols(); ++i) {
        if (!shape.outlier.empty() && shape.outlier[static_cast<std::size_t>(i)]) continue;
        squares += (shape.points.col(i) - shape.clean.col(i)).squaredNorm();
        ++used;
    }
    EXPECT_NEAR(std::sqrt(squares / (3.0 * static_cast<double>(used))), 0.05, 0.002);
}

TEST(Shapes, UnknownNameIsRefusedWithTheKnownOnes) {
    try {
        (void)make_shape("teapot", {});
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
        EXPECT_THAT(error.what(), testing::HasSubstr("curvenet"));
    }
}

TEST(Shapes, DistancesOfKnownPlaces) {
    const Sampling few{.points = 10};
    EXPECT_DOUBLE_EQ(make_plane(few).distance({0.3, -0.2, 0.7}), 0.7);
    EXPECT_DOUBLE_EQ(make_plane(few).distance({4, 5, 0}), 5.0);
    EXPECT_DOUBLE_EQ(make_sphere(few).distance({0, 0, 0.25}), 0.75);
    EXPECT_DOUBLE_EQ(make_cube(few).distance({0, 0, 0}), 1.0);
    EXPECT_DOUBLE_EQ(make_cube(few).distance({2, 2, 2}), std::sqrt(3.0));
    EXPECT_NEAR(make_thin_plate(few, 0.2).distance({0, 0, 0.02}), 0.08, 1e-12);
    EXPECT_NEAR(make_circle(few).distance({3, 4, 0}), 4.0, 1e-9);
    EXPECT_NEAR(make_circle(few).distance({0, 0, 2}), std::sqrt(5.0), 1e-9);
    EXPECT_DOUBLE_EQ(make_line(few).distance({4, 4, 0}), 5.0);
}

TEST(Shapes, FinOpensByItsAngle) {
    const TestShape fin = make_fin({.points = 10}, 60.0);
    EXPECT_NEAR(fin.distance({0.25, 0, std::sqrt(3.0) / 4}), 0.0, 1e-12);
    EXPECT_NEAR(fin.distance({0.5, 0, 0.5 * std::tan(std::numbers::pi / 6)}),
                0.5 * std::tan(std::numbers::pi / 6), 1e-12);
}

TEST(Shapes, CubeSamplesAreUniformByArea) {
    const TestShape cube = make_cube({.points = 60000});
    std::vector<int> per_face(6, 0);
    for (const std::uint32_t piece : cube.piece) ++per_face[piece];
    for (const int count : per_face) EXPECT_NEAR(count, 10000, 500);
}

TEST(Shapes, DensityStepIsFourToOne) {
    const TestShape shape = make_density_step({.points = 50000});
    const auto left = (shape.points.row(0).array() < 0).count();
    EXPECT_NEAR(static_cast<double>(left) / static_cast<double>(50000 - left), 4.0, 0.15);
}

TEST(Shapes, IsolatedPointsAreFarAndFlagged) {
    const TestShape shape = make_isolated_points({.points = 5000});
    EXPECT_EQ(std::accumulate(shape.outlier.begin(), shape.outlier.end(), 0), 100);
    for (std::size_t i = 0; i < shape.outlier.size(); ++i) {
        if (shape.outlier[i]) {
            EXPECT_GE(shape.distance(shape.points.col(static_cast<Eigen::Index>(i))), 0.8);
        }
    }
}

TEST(Shapes, MeshSamplesAreUniformByArea) {
    const TestShape cube = make_from_mesh("mesh", cube_mesh(1.0, 3), {.points = 60000});
    for (int axis = 0; axis < 3; ++axis) {
        const auto on_face = (cube.points.row(axis).array() == 1.0).count();
        EXPECT_NEAR(static_cast<double>(on_face), 10000, 500);
    }
    const auto in_corner = ((cube.points.array() > 1.0 / 3).colwise().all()).count();
    EXPECT_NEAR(static_cast<double>(in_corner), 60000.0 / 18, 250);
}

TEST(Shapes, BodiesHaveTheDiagonalsOfThePaper) {
    EXPECT_NEAR(make_pyramid({.points = 10}).diagonal(), 125.51, 0.01);
    EXPECT_NEAR(make_disk_segment({.points = 10}).diagonal(), 7.6156, 0.001);
    EXPECT_NEAR(make_head({.points = 10}).diagonal(), 51.96, 0.01);
    EXPECT_NEAR(make_shutter({.points = 10}).diagonal(), 2.07, 0.02);
    EXPECT_NEAR(make_cube({.points = 10}, 4.54 / std::sqrt(3.0)).diagonal(), 9.08, 1e-9);
}

TEST(Shapes, CubeWithCurveHasThePapersDiagonal) {
    EXPECT_NEAR(make_cube_with_curve({.points = 10}).diagonal(), 8.8, 0.05);
}

TEST(Shapes, HelixIsUniformByLength) {
    const TestShape helix = make_helix({.points = 40000});
    const auto first_turn = (helix.points.row(2).array() < 2.0 / 3.0).count();
    EXPECT_NEAR(static_cast<double>(first_turn) / 40000.0, 1.0 / 3.0, 0.01);
}

TEST(Curvenet, IsAsDefined) {
    const TestShape shape = make_curvenet({.points = 40000});
    ASSERT_EQ(shape.pieces.size(), 13U);
    EXPECT_EQ(shape.ends.size(), 20U);
    EXPECT_EQ(shape.borders.size(), 4U);
    const auto flags = shape.on_curve();
    EXPECT_NEAR(static_cast<double>(std::count(flags.begin(), flags.end(), 1)), 4000.0, 250.0);
    const double x = 3.0, y = -2.0;
    EXPECT_NEAR(shape.distance({x, y, 1.2 * std::sin(x / 4) * std::cos(y / 5)}), 0.0, 1e-12);
    EXPECT_NEAR(
        shape.distance(
            {1.0, 11.0, 4.5 + 1.5 * std::cos(std::numbers::pi / 33.1) + 0.4 * std::sin(1.0)}),
        0.0, 1e-7);
    EXPECT_NEAR(shape.distance({12.4, -12.4, 5.0}), 0.0, 1e-9);
    EXPECT_NEAR(shape.diagonal(), 47.4, 0.1);
}

TEST(Curvenet, NoisyErrorIsThatOfTheNoise) {
    const TestShape shape = make_curvenet({.points = 20000, .noise = 0.124});
    std::vector<std::uint8_t> on_sheet = shape.on_curve();
    for (auto& flag : on_sheet) flag = !flag;
    // Off a surface there is one direction of noise, off a curve there are two.
    EXPECT_NEAR(error_to_shape(shape.points, shape, on_sheet).rmse, 0.124, 0.004);
    EXPECT_NEAR(error_to_shape(shape.points, shape, shape.on_curve()).rmse, 0.124 * std::sqrt(2.0),
                0.006);
}

}  // namespace
}  // namespace lpf::test
