#include "core/shape/noise_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lpf {
namespace {

/// Factors .5, 1, 1.5, ... along x.
NoiseMap rising_map() {
    Points places(3, 10);
    std::vector<double> factors;
    for (int i = 0; i < 10; ++i) {
        places.col(i) = Eigen::Vector3d(i, 0, 0);
        factors.push_back(0.5 + 0.5 * i);
    }
    return {places, factors};
}

TEST(NoiseMap, IsEvenUnlessToldOtherwise) {
    const NoiseMap map;
    EXPECT_TRUE(map.is_even());
    EXPECT_EQ(map.factor_at({1, 2, 3}), 1.0);
    EXPECT_EQ(map.least(), 1.0);
    EXPECT_EQ(map.most(), 1.0);
}

TEST(NoiseMap, KnowsItsExtremes) {
    const NoiseMap map = rising_map();
    EXPECT_FALSE(map.is_even());
    EXPECT_EQ(map.least(), 0.5);
    EXPECT_EQ(map.most(), 5.0);
}

TEST(NoiseMap, RisesBetweenItsPlacesAsTheyDo) {
    const NoiseMap map = rising_map();
    for (double x = 1; x < 8; x += 0.25) {
        EXPECT_NEAR(map.factor_at({x, 0, 0}), 0.5 + 0.5 * x, 0.26) << x;
    }
}

TEST(NoiseMap, JumpsNowhere) {
    const NoiseMap map = rising_map();
    for (double x = 0; x < 9; x += 0.01) {
        const double step = map.factor_at({x + 0.01, 0.1, 0}) - map.factor_at({x, 0.1, 0});
        EXPECT_LT(std::abs(step), 0.02) << x;
    }
}

TEST(NoiseMap, OfOnePlaceIsTheSameEverywhere) {
    const NoiseMap map(Points::Zero(3, 1), {3.0});
    EXPECT_EQ(map.factor_at({0, 0, 0}), 3.0);
    EXPECT_EQ(map.factor_at({5, 0, 0}), 3.0);
}

TEST(NoiseMap, OfPlacesOnEachOtherHasANumber) {
    const NoiseMap map(Points::Zero(3, 6), std::vector<double>(6, 2.0));
    EXPECT_EQ(map.factor_at({0, 0, 0}), 2.0);
    EXPECT_EQ(map.factor_at({1, 0, 0}), 2.0);
}

}  // namespace
}  // namespace lpf
