#include "core/field/seed_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lpf {
namespace {

SeedingParams adapting(double noise, const NoiseMap& map = {}) {
    return {.radius = 1.0, .noise = noise, .noise_map = map, .adapt_radius = true};
}

NoiseMap from_to(double least, double most) {
    Points places(3, 2);
    places << 0, 1, 0, 0, 0, 0;
    return {places, {least, most}};
}

TEST(SeedSizes, AreThatOfTheUserOrFallFromLargeToSmall) {
    EXPECT_EQ(radii_to_try({.radius = 0.3}), std::vector{0.3});
    const std::vector<double> radii = radii_to_try(adapting(0.2));
    EXPECT_TRUE(std::ranges::is_sorted(radii, std::greater<>()));
    EXPECT_EQ(largest_radius(adapting(0.2)), radii.front());
    EXPECT_GT(radii.front(), 1.0);
    EXPECT_GE(radii.back(), least_radius(0.2));
}

TEST(SeedSizes, AreNotLargerThanAskedForWithoutNoise) {
    EXPECT_LE(radii_to_try(adapting(0.01)).front(), 1.0);
}

TEST(SeedSizes, AreAtLeastOneInHoweverMuchNoise) {
    EXPECT_EQ(radii_to_try(adapting(10.0)), std::vector{1.0});
}

TEST(SeedSizes, ReachFromTheLeastNoiseToTheMost) {
    const std::vector<double> radii = radii_to_try(adapting(0.04, from_to(0.5, 4)));
    EXPECT_GT(radii.front(), 1.0) << "there is much noise somewhere";
    EXPECT_LT(radii.back(), least_radius(0.16)) << "and little elsewhere";
}

TEST(SeedSizes, SuitTheNoiseOfAPlaceWhereItVaries) {
    const SeedingParams even = adapting(0.1);
    EXPECT_TRUE(suits_noise(even, 0.25, 0.4)) << "sizes are chosen for all of it";
    const SeedingParams varied = adapting(0.1, from_to(0.1, 4));
    EXPECT_FALSE(suits_noise(varied, 0.25, 0.4)) << "too small to average";
    EXPECT_TRUE(suits_noise(varied, 2.0, 0.4));
    EXPECT_FALSE(suits_noise(varied, 2.0, 0.01)) << "nothing to average";
    EXPECT_TRUE(suits_noise(varied, 0.25, 0.01));
}

TEST(SeedSizes, EndSoonerWhereThereIsMoreNoise) {
    EXPECT_FALSE(is_last_for_noise(adapting(0.1), 0.2, 0.4));
    const SeedingParams varied = adapting(0.1, from_to(0.1, 4));
    EXPECT_TRUE(is_last_for_noise(varied, 0.7, 0.4));
    EXPECT_FALSE(is_last_for_noise(varied, 0.7, 0.1));
}

}  // namespace
}  // namespace lpf
