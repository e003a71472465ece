#include "core/shape/spread.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace lpf {
namespace {

/// A ball with noisy points of horizontal sheets at +-half_gap.
NearPoints sheets_in_ball(int points, double noise, double half_gap) {
    NearPoints ball;
    ball.reserve(static_cast<std::size_t>(points));
    Random random(9, 2);
    while (ball.size < static_cast<std::size_t>(points)) {
        const double x = random.uniform(-1, 1);
        const double y = random.uniform(-1, 1);
        const double z = (ball.size % 2 == 0 ? 1 : -1) * half_gap + noise * random.normal();
        if (x * x + y * y + z * z > 1) continue;
        ball.x[ball.size] = static_cast<float>(x);
        ball.y[ball.size] = static_cast<float>(y);
        ball.z[ball.size] = static_cast<float>(z);
        ++ball.size;
    }
    return ball;
}

Spread spread_of(int points, double noise, double half_gap) {
    std::vector<double> heights;
    return spread_in(sheets_in_ball(points, noise, half_gap), heights);
}

TEST(Spread, IsTheNoiseOffAPlane) {
    const Spread spread = spread_of(2500, 0.1, 0);
    EXPECT_NEAR(spread.deviation, 0.1, 0.004);
    EXPECT_NEAR(spread.kurtosis, 3.0, 0.25);
    EXPECT_EQ(spread.freedom, 2500 - 6) << "a quadric has six coefficients";
    EXPECT_FALSE(spread.is_parted);
}

TEST(Spread, GivesBackWhatTheBallHasCutOff) {
    for (const double noise : {0.05, 0.1, 0.2, 0.25, 0.3}) {
        const Spread spread = spread_of(2500, noise, 0);
        EXPECT_NEAR(uncut(spread.deviation), noise, 0.05 * noise);
    }
    EXPECT_LT(spread_of(2500, 0.3, 0).deviation, 0.27) << "much is cut off";
    EXPECT_EQ(uncut(0.0), 0.0);
}

TEST(Spread, OfABallFullOfNoiseIsTooWideForIt) {
    const Spread spread = spread_of(2500, 5.0, 0);
    EXPECT_GT(uncut(spread.deviation), 1.0 / 3) << "three sigma do not fit into the ball";
}

TEST(Spread, LeavesOutWhatIsRound) {
    NearPoints ball = sheets_in_ball(2500, 0.1, 0);
    for (std::size_t i = 0; i < ball.size; ++i) {
        ball.z[i] += 0.4F * ball.x[i] * ball.x[i] - 0.3F * ball.x[i] * ball.y[i];
    }
    std::vector<double> heights;
    EXPECT_NEAR(spread_in(ball, heights).deviation, 0.1, 0.006);
}

TEST(Spread, OfAFewPointsIsOffAPlane) {
    EXPECT_EQ(spread_of(13, 0.1, 0).freedom, 13 - 3);
    EXPECT_EQ(spread_of(14, 0.1, 0).freedom, 14 - 6);
}

TEST(Spread, TellsACurve) {
    EXPECT_FALSE(spread_of(500, 0.1, 0).is_curve);
    NearPoints ball = sheets_in_ball(500, 0.1, 0);
    for (std::size_t i = 0; i < ball.size; ++i) ball.y[i] = -ball.z[(i + 1) % ball.size];
    std::vector<double> heights;
    EXPECT_TRUE(spread_in(ball, heights).is_curve);
}

TEST(Spread, BetweenNeighboursIsTheNoise) {
    std::vector<double> heights;
    EXPECT_NEAR(deviation_between_neighbours(sheets_in_ball(2500, 0.1, 0), heights), 0.1, 0.02);
}

TEST(Spread, BetweenNeighboursLeavesOutDetail) {
    NearPoints ball = sheets_in_ball(2500, 0.02, 0);
    for (std::size_t i = 0; i < ball.size; ++i) ball.z[i] += 0.1F * std::sin(8 * ball.x[i]);
    std::vector<double> heights;
    EXPECT_GT(spread_in(ball, heights).whole, 0.06);
    EXPECT_NEAR(deviation_between_neighbours(ball, heights), 0.02, 0.007);
}

TEST(Spread, IsOffTheNearerOfTwoPlanesThatStandApart) {
    const Spread spread = spread_of(2500, 0.05, 0.2);
    EXPECT_TRUE(spread.is_parted);
    EXPECT_NEAR(spread.deviation, 0.05, 0.003);
}

TEST(Spread, ShowsSheetsThatNoiseHidesByItsKurtosis) {
    const Spread spread = spread_of(2500, 0.1, 0.1);
    EXPECT_FALSE(spread.is_parted);
    EXPECT_NEAR(spread.kurtosis, 3 - 2 * 0.25, 0.15) << "half of the variance is the sheets'";
}

TEST(Spread, OfManyPointsIsThatOfSomeOfThem) {
    const Spread spread = spread_of(30000, 0.1, 0);
    EXPECT_LT(spread.freedom, 3001);
    EXPECT_NEAR(spread.deviation, 0.1, 0.004);
}

TEST(Spread, OfAFewPointsDoesNotTakeChanceForTwoPlanes) {
    EXPECT_FALSE(spread_of(30, 0.1, 0).is_parted);
}

}  // namespace
}  // namespace lpf
