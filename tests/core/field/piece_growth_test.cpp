#include "core/field/piece_growth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/blur.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

using Eigen::Vector3d;

constexpr float kExtent = 1.1F;

/// The piece through a place of a shape, and how it lies in space.
struct Grown {
    Frame frame;
    Piece piece;
    TargetArea target;  ///< flattened

    [[nodiscard]] Vector3d on_shape(float x, float y) const {
        const Eigen::Vector3f in_plane(x, piece.is_curve() ? 0.0F : y, 0);
        return frame.to_world(in_plane + piece.shape(x, y));
    }
};

Grown grow(const Points& points, const Vector3d& centre, double radius, double noise) {
    Grown grown;
    grown.frame.centre = centre;
    grown.frame.radius = radius;
    const PointGrid grid(points, 0.55 * radius);
    grid.gather(grown.frame.centre, grown.frame.radius, kExtent, grown.target);
    PieceGrower grower(true);
    grown.piece = grower.grow(grown.target, static_cast<float>(noise / radius), kExtent);
    grown.frame.origin = grown.piece.origin;
    grown.frame.axes = grown.piece.axes;
    grown.target.to_frame(grown.frame);
    flatten(grown.piece, grown.target);
    return grown;
}

using Distance = std::function<double(const Vector3d&)>;

/// RMS distance of the middle of a piece to what it should be, in the input's length.
double rms_error(const Grown& grown, const Distance& distance) {
    double squares = 0;
    double count = 0;
    for (float x = -0.6F; x <= 0.61F; x += 0.1F) {
        for (float y = -0.6F; y <= 0.61F; y += 0.1F) {
            if (grown.piece.is_curve() && std::abs(y) > 0.01F) continue;
            if (std::hypot(x, y) > 0.61F) continue;
            squares += std::pow(distance(grown.on_shape(x, y)), 2);
            count += 1;
        }
    }
    return std::sqrt(squares / count);
}

Distance to(const test::TestShape& shape) {
    return [&shape](const Vector3d& p) { return shape.distance(p); };
}

TEST(PieceGrower, AveragesNoiseOnAPlaneAndKnowsHowWell) {
    double ratio = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U}) {
        const auto plane = test::make_plane({.points = 8000, .noise = 0.03, .seed = seed});
        const Grown grown = grow(plane.points, Vector3d::Zero(), 0.3, 0.03);
        ASSERT_EQ(grown.piece.dimension, kSurface);
        EXPECT_EQ(grown.piece.crease.slope, 0.0F);
        const double error = rms_error(grown, to(plane));
        EXPECT_LT(error, 0.2 * 0.03);
        ratio += error / (0.3 * std::sqrt(static_cast<double>(grown.piece.squared_error))) / 8;
    }
    EXPECT_GT(ratio, 0.4);
    EXPECT_LT(ratio, 1.6);
}

TEST(PieceGrower, TakesBackWhatNoiseAddsToABend) {
    const auto sphere = test::make_sphere({.points = 100000, .noise = 0.08});
    const Grown grown = grow(sphere.points, {0, 0, 1}, 0.35, 0.08);
    ASSERT_EQ(grown.piece.dimension, kSurface);
    EXPECT_LT(rms_error(grown, to(sphere)), 0.1 * 0.08);
    const double mean = grown.frame.to_world(grown.piece.mean(0, 0)).norm();
    const double shape = grown.on_shape(0, 0).norm();
    // Points scattered about a sphere of radius 1 lie sigma^2 further out on average.
    EXPECT_NEAR(std::abs(shape - mean), 0.08 * 0.08, 0.4 * 0.08 * 0.08);
}

TEST(PieceGrower, FollowsACurve) {
    const auto helix = test::make_helix({.points = 20000, .noise = 0.01});
    const Grown grown = grow(helix.points, helix.clean.col(7), 0.15, 0.01);
    ASSERT_TRUE(grown.piece.is_curve());
    EXPECT_LT(rms_error(grown, to(helix)), 0.003);
}

TEST(PieceGrower, FollowsOneOfTwoCurvesThroughTheirCrossing) {
    const auto crossing = test::make_crossing_curves({.points = 4000, .noise = 0.01});
    const Grown grown = grow(crossing.points, Vector3d::Zero(), 0.25, 0.01);
    ASSERT_TRUE(grown.piece.is_curve());
    EXPECT_LT(rms_error(grown, to(crossing)), 0.005);
}

TEST(PieceGrower, FoldsAtAnEdgeWithoutRoundingIt) {
    const double noise = 0.03;
    const auto cube = test::make_cube({.points = 150000, .noise = noise});
    const Grown grown = grow(cube.points, {0.1, 0.98, 0.98}, 0.35, noise);
    ASSERT_EQ(grown.piece.dimension, kSurface);
    EXPECT_NEAR(std::abs(grown.piece.crease.slope), 1.0, 0.15) << "two faces at 45 degrees";
    EXPECT_LT(rms_error(grown, to(cube)), 0.15 * noise);
    // The mean of the noisy points lies inside of the edge by .8 sigma along the diagonal.
    const float at = grown.piece.crease.at;
    const Eigen::Vector3f foot(at * grown.piece.crease.normal_x, at * grown.piece.crease.normal_y,
                               0);
    const Vector3d mean = grown.frame.to_world(foot + grown.piece.mean(foot.x(), foot.y()));
    EXPECT_NEAR(cube.distance(mean), std::sqrt(0.5) * 0.8 * noise, 0.25 * noise);
}

/// Growing beside an edge of a noisy cube: how many smooth pieces promise not to be useless.
int believed_at_edge(bool refuses_edges) {
    constexpr double kNoise = 0.025;
    constexpr double kRadius = 0.2;
    const auto cube = test::make_cube({.points = 60000, .noise = kNoise});
    const PointGrid grid(cube.points, 0.1);
    PieceGrower grower(refuses_edges);
    int believed = 0;
    for (double along = -0.8; along <= 0.8; along += 0.02) {
        TargetArea target;
        grid.gather({along, 1.0, 0.95}, kRadius, kExtent, target);
        const Piece piece = grower.grow(target, static_cast<float>(kNoise / kRadius), kExtent);
        believed += piece.crease.slope == 0 && piece.squared_error < 0.1F;
    }
    return believed;
}

TEST(PieceGrower, RefusesSmoothPiecesThatMeetAnEdge) {
    const int taken = believed_at_edge(false);
    EXPECT_GT(taken, 10);
    EXPECT_LT(2 * believed_at_edge(true), taken);
}

TEST(PieceGrower, FindsNoCreaseOnASphere) {
    const auto sphere = test::make_sphere({.points = 60000, .noise = 0.02});
    for (int i = 0; i < 30; ++i) {
        const Grown grown = grow(sphere.points, sphere.clean.col(i), 0.4, 0.02);
        EXPECT_EQ(grown.piece.crease.slope, 0.0F);
    }
}

TEST(PieceGrower, TellsTwoSheetsThreeSigmaApart) {
    const double noise = 0.02;
    const auto plate = test::make_thin_plate({.points = 60000, .noise = noise}, 3 * noise);
    const Grown grown = grow(plate.points, Vector3d::Zero(), 0.2, noise);
    ASSERT_EQ(grown.piece.dimension, kSurface);
    EXPECT_NEAR(0.2 * double{grown.piece.half_gap(0, 0)}, 1.5 * noise, 0.15 * noise);
    EXPECT_NEAR(grown.on_shape(0, 0).z(), 0, 0.2 * noise) << "the middle of both";
}

TEST(PieceGrower, TakesStrongerNoiseForNoiseNotForSheets) {
    const auto plane = test::make_plane({.points = 20000, .noise = 0.04});
    const Grown grown = grow(plane.points, Vector3d::Zero(), 0.3, 0.025);
    EXPECT_EQ(grown.piece.sheets[0], 0.0F);
}

TEST(PieceGrower, LeavesAWireAboveAWallToItself) {
    const double noise = 0.008;
    const double height = 0.06;
    const auto wall = test::make_plane({.points = 40000, .noise = noise});
    Points points(3, wall.points.cols() + 2000);
    points.leftCols(wall.points.cols()) = wall.points;
    Random random(5, 5);
    for (Eigen::Index i = wall.points.cols(); i < points.cols(); ++i) {
        points.col(i) = Vector3d(random.uniform(-1, 1), noise * random.normal(),
                                 height + noise * random.normal());
    }
    int followed = 0;
    for (const double x : {-0.6, -0.3, 0.0, 0.3, 0.6}) {
        const Grown on_wire = grow(points, {x, 0, height}, 0.12, noise);
        if (!on_wire.piece.is_curve()) continue;
        ++followed;
        EXPECT_LT(rms_error(on_wire,
                            [&](const Vector3d& p) { return std::hypot(p.y(), p.z() - height); }),
                  0.5 * noise);
    }
    EXPECT_GE(followed, 4);
    const Grown on_wall = grow(points, {0.1, 0.05, 0}, 0.12, noise);
    ASSERT_EQ(on_wall.piece.dimension, kSurface);
    EXPECT_LT(rms_error(on_wall, [](const Vector3d& p) { return std::abs(p.z()); }), 0.3 * noise);
}

TEST(PieceGrower, FindsNothingInAFewPoints) {
    const auto plane = test::make_plane({.points = 2000});
    const Grown grown = grow(plane.points.leftCols(7), plane.points.col(0), 3.0, 0.01);
    EXPECT_FALSE(grown.piece.exists());
    EXPECT_EQ(grown.target.size, 7U) << "a piece that does not exist keeps all";
}

TEST(Piece, MembersLieWithinTheReachOfTheNearerSheet) {
    Piece piece;
    piece.dimension = kSurface;
    piece.reach = 0.1F;
    piece.sheets[0] = 0.04F;  // at heights .2 and -.2
    TargetArea target;
    target.reserve(5);
    const float heights[] = {0.0F, 0.15F, 0.35F, -0.25F, -0.31F};
    for (std::uint32_t i = 0; i < 5; ++i) {
        target.x[i] = target.y[i] = 0;
        target.z[i] = heights[i];
        target.index[i] = i;
    }
    target.size = 5;
    TargetArea wide = target;
    keep_members(piece, 1.0F, target);
    ASSERT_EQ(target.size, 2U);
    EXPECT_EQ(target.index[0], 1U);
    EXPECT_EQ(target.index[1], 3U);
    EXPECT_NEAR(target.z[0], -0.05F, 1e-6);
    EXPECT_NEAR(target.z[1], -0.05F, 1e-6);
    keep_members(piece, 1.2F, wide);
    EXPECT_EQ(wide.size, 3U);
}

TEST(Blur, IsTheMeanOfTheDistanceOfNoisyPoints) {
    for (const double d : {-1.0, -0.3, 0.0, 0.05, 0.2, 0.6}) {
        double mean = 0;
        double weight = 0;
        for (double t = -6; t <= 6; t += 0.001) {
            mean += std::exp(-t * t / 2) * std::abs(d + 0.2 * t);
            weight += std::exp(-t * t / 2);
        }
        const BlurredDistance blurred = blur(static_cast<float>(d), 0.2F);
        EXPECT_NEAR(blurred.distance, mean / weight, 2e-5) << d;
        EXPECT_NEAR(blurred.sign, std::erf(d / 0.2 / std::sqrt(2.0)), 1e-4) << d;
    }
}

}  // namespace
}  // namespace lpf
