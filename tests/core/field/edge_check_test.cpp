#include "core/field/edge_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/random.h"
#include "tests/core/field/targets.h"

namespace lpf {
namespace {

constexpr float kNoise = 0.05F;
constexpr float kReach = 2.6F * kNoise;

/// Noisy points of a shape in the unit ball.
PieceSample sample_of(const std::function<Eigen::Vector3d(Random&)>& place, int count = 4000) {
    Random random(3, 1);
    Eigen::Matrix3Xf points(3, count);
    for (int i = 0; i < count;) {
        Eigen::Vector3d at = place(random);
        for (double& x : at) x += double{kNoise} * random.normal();
        if (at.norm() <= 1) points.col(i++) = at.cast<float>();
    }
    PieceSample sample;
    sample.assign(test::target_of(points), 100000, 1.0F, 2.0F, 1.0F);
    return sample;
}

/// Whether the plane z = slope x + height meets an edge.
bool meets_edge(PieceSample sample, float slope = 0.0F, float height = 0.0F) {
    Piece piece;
    piece.dimension = kSurface;
    piece.noise = kNoise;
    piece.steepness = std::hypot(1.0F, slope);
    piece.reach = kReach * piece.steepness;
    piece.coefficients[0] = height;
    piece.coefficients[1] = slope;
    sample.look_along(piece, sample.size());
    sample.measure(piece, sample.size());
    return meets_edge(sample, piece);
}

Eigen::Vector3d on_plane(Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), 0};
}

/// A roof with its ridge along y, at z = 0.
Eigen::Vector3d on_roof(Random& random) {
    const double x = random.uniform(-1, 1);
    return {x, random.uniform(-1, 1), -std::abs(x)};
}

TEST(EdgeCheck, FindsNoneOnAPlane) { EXPECT_FALSE(meets_edge(sample_of(on_plane))); }

TEST(EdgeCheck, FindsTheRidgeThatAPlaneCutsOff) {
    EXPECT_TRUE(meets_edge(sample_of(on_roof), 0.0F, -0.1F));
}

TEST(EdgeCheck, FindsTheEdgeThatAFaceRunsUpTo) {
    const auto place = [](Random& random) -> Eigen::Vector3d {
        const double x = random.uniform(-1, 1);
        return {std::min(x, 0.0), random.uniform(-1, 1), -std::max(x, 0.0)};
    };
    EXPECT_TRUE(meets_edge(sample_of(place)));
}

TEST(EdgeCheck, FindsThatAPlaneLeansAcrossTheShape) {
    EXPECT_TRUE(meets_edge(sample_of(on_plane), 0.5F));
}

TEST(EdgeCheck, NeedsPoints) {
    EXPECT_TRUE(meets_edge(sample_of(on_roof, 300), 0.0F, -0.1F));
    EXPECT_FALSE(meets_edge(sample_of(on_plane, 300)));
    EXPECT_FALSE(meets_edge(sample_of(on_roof, 60), 0.0F, -0.1F));
}

TEST(EdgeCheck, FindsNoneOnAWallUnderAWire) {
    const auto place = [](Random& random) -> Eigen::Vector3d {
        if (random.uniform(0, 1) < 0.6) return on_plane(random);
        return {random.uniform(-1, 1), 0, 4.0 * double{kNoise}};
    };
    EXPECT_FALSE(meets_edge(sample_of(place)));
}

TEST(EdgeCheck, FindsNoneWhereASheetEndsByItself) {
    const auto place = [](Random& random) -> Eigen::Vector3d {
        return {random.uniform(-1, 0), random.uniform(-1, 1), 0};
    };
    EXPECT_FALSE(meets_edge(sample_of(place)));
}

TEST(EdgeCheck, FindsNoneOfCurves) {
    PieceSample sample = sample_of(on_plane);
    Piece curve;
    curve.dimension = kCurve;
    curve.reach = kReach;
    sample.look_along(curve, sample.size());
    sample.measure(curve, sample.size());
    EXPECT_FALSE(meets_edge(sample, curve));
}

}  // namespace
}  // namespace lpf
