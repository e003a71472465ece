#include "core/field/tube_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/base/random.h"
#include "core/field/piece_fit.h"

namespace lpf {
namespace {

constexpr float kExtent = 1.1F;
constexpr float kNoise = 0.06F;
constexpr float kSigmas = 2.6F;

/// Where the shape is around the x axis: an angle from 0 to 2 pi to (y, z).
using Section = std::function<Eigen::Vector2f(float angle)>;

/// What widen_to_tube makes of a curve that is fitted to noisy points of a rod along x.
/// @param bend the axis lies at this height at the ends
Piece widened(const Section& section, float bend = 0.0F) {
    TargetArea target;
    target.reserve(3000);
    Random random(7, 1);
    const auto normal = [&] { return kNoise * static_cast<float>(random.normal()); };
    for (target.size = 0; target.size < 3000; ++target.size) {
        const auto x = static_cast<float>(random.uniform(-1, 1));
        const auto angle = static_cast<float>(random.uniform(0, 2 * std::numbers::pi));
        const Eigen::Vector2f around = section(angle);
        target.x[target.size] = x;
        target.y[target.size] = around.x() + normal();
        target.z[target.size] = around.y() + bend * x * x + normal();
    }
    PieceSample sample;
    sample.assign(target, 100000, kExtent, 2.0F, kExtent);
    Piece piece;
    piece.dimension = kCurve;
    piece.noise = kNoise;
    piece.reach = 2.2F * kNoise;
    // As if it had begun on one side of the rod.
    piece.coefficients[0] = section(0).x();
    sample.look_along(piece, sample.size());
    sample.measure(piece, sample.size());
    fit_smooth(sample, sample.size(), piece);
    sample.measure(piece, sample.size());
    estimate_error(sample, piece);
    widen_to_tube(sample, kSigmas, piece);
    return piece;
}

Section circle(float radius) {
    return [=](float angle) {
        return Eigen::Vector2f(radius * std::cos(angle), radius * std::sin(angle));
    };
}

class TubeOf : public testing::TestWithParam<float> {};

TEST_P(TubeOf, HasTheAxisAndTheRadiusOfTheRod) {
    const float radius = GetParam() * kNoise;
    const Piece piece = widened(circle(radius), 0.15F);
    ASSERT_TRUE(piece.is_tube());
    for (const float x : {-0.6F, 0.0F, 0.6F}) {
        EXPECT_NEAR(piece.half_gap(x, 0), radius, 0.15F * kNoise);
        EXPECT_NEAR(piece.shape(x, 0).y(), 0, 0.15F * kNoise);
        EXPECT_NEAR(piece.shape(x, 0).z(), 0.15F * x * x, 0.15F * kNoise);
    }
}

INSTANTIATE_TEST_SUITE_P(Sigmas, TubeOf, testing::Values(1.0F, 2.0F, 3.5F), [](const auto& test) {
    return "Tenths" + std::to_string(std::lround(10 * test.param));
});

TEST(TubeFit, LeavesACurveAlone) { EXPECT_FALSE(widened(circle(0)).is_tube()); }

TEST(TubeFit, LeavesAStripOfASurfaceAlone) {
    const Section strip = [](float angle) {
        return Eigen::Vector2f(8 * kNoise * (angle / std::numbers::pi_v<float> - 1), 0);
    };
    EXPECT_FALSE(widened(strip).is_tube());
}

TEST(TubeFit, LeavesTwoCurvesAlone) {
    const Section two = [](float angle) {
        return Eigen::Vector2f(angle < std::numbers::pi_v<float> ? 2.5F * kNoise : -2.5F * kNoise,
                               0);
    };
    EXPECT_FALSE(widened(two).is_tube());
}

TEST(Tube, IsWhereItsPointsAreMeasuredFrom) {
    Piece tube;
    tube.dimension = kCurve;
    tube.sheets[0] = 0.25F;
    EXPECT_FLOAT_EQ(tube.squared_offset(0.3F, 0.3F, 0.4F), 0);
    EXPECT_FLOAT_EQ(tube.squared_offset(0.3F, 0, 0.7F), 0.04F);
    EXPECT_FLOAT_EQ(tube.squared_offset(0.3F, 0, 0), 0.25F);
    float y = 0.6F;
    float z = 0.8F;
    tube.to_nearer_sheet(0.1F, 0, y, z);
    EXPECT_FLOAT_EQ(y, 0.3F);
    EXPECT_FLOAT_EQ(z, 0.4F);
}

}  // namespace
}  // namespace lpf
