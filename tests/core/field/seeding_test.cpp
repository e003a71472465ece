#include "core/field/seeding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/shape/poisson_sampling.h"
#include "tests/core/clouds.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr double kRadius = 0.15;

SeedingParams params_for(double noise_spread) {
    return {.radius = kRadius, .spacing = 0.5, .noise_spread = noise_spread, .random_seed = 7};
}

std::vector<Frame> seeds_of(const Points& points, double noise_spread, int threads = 1) {
    const PointGrid grid(points, 0.55 * kRadius);
    return place_seeds(points, grid, params_for(noise_spread), {.threads = threads});
}

/// Distance from a point to the nearest seed, in units of that seed's radius; the least of all
/// seeds.
double least_share(const Eigen::Vector3d& point, const std::vector<Frame>& seeds) {
    double least = 1e300;
    for (const Frame& seed : seeds) {
        least = std::min(least, (point - seed.centre).norm() / seed.radius);
    }
    return least;
}

class SeedingOf : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(SeedingOf, CoversEveryPointWithinTheSpacing) {
    const Points& points = GetParam().points;
    for (const double noise_spread : {0.0, 1e-6, 0.02}) {
        const std::vector<Frame> seeds = seeds_of(points, noise_spread);
        for (Eigen::Index i = 0; i < points.cols(); ++i) {
            ASSERT_LE(least_share(points.col(i), seeds), 0.5 * (1 + 1e-9)) << noise_spread;
        }
    }
}

TEST_P(SeedingOf, PutsSeedsOfOneSizeApart) {
    const std::vector<Frame> seeds = seeds_of(GetParam().points, 1e-6);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (seeds[i].radius != seeds[j].radius) continue;
            ASSERT_GE((seeds[i].centre - seeds[j].centre).norm(), 0.5 * seeds[i].radius);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, SeedingOf, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Seeding, WithoutNoiseSpreadIsThePoissonDiskSubset) {
    const Points points = test::make_sphere({.points = 4000, .noise = 0.02}).points;
    std::vector<Eigen::Vector3d> expected;
    for (const std::uint32_t i : poisson_disk_subset(points, 0.5 * kRadius, 7, {})) {
        expected.emplace_back(points.col(i));
    }
    const std::vector<Frame> seeds = seeds_of(points, 0.0);
    ASSERT_EQ(seeds.size(), expected.size());
    for (const Frame& seed : seeds) {
        EXPECT_EQ(seed.radius, kRadius);
        EXPECT_NE(std::ranges::find(expected, seed.centre), expected.end());
    }
}

TEST(Seeding, KeepsTheRadiusOnOneSheetWithNoiseAndOnEdges) {
    const test::Sampling sampling{.points = 20000, .noise = 0.02, .seed = 3};
    for (const auto& shape : {test::make_open_sheet(sampling), test::make_cube(sampling)}) {
        const std::vector<Frame> seeds = seeds_of(shape.points, 0.03);
        const auto smaller =
            std::ranges::count_if(seeds, [](const Frame& seed) { return seed.radius < kRadius; });
        EXPECT_LE(static_cast<double>(smaller), 0.02 * static_cast<double>(seeds.size()))
            << shape.name;
    }
}

TEST(Seeding, ShrinksWhereTwoSheetsAreNearerThanTheRadius) {
    const double gap = 0.12;
    const Points points = test::make_thin_plate({.points = 40000, .noise = 0.002}, gap).points;
    const std::vector<Frame> seeds = seeds_of(points, 0.003);
    const auto one_sided =
        std::ranges::count_if(seeds, [&](const Frame& seed) { return 1.1 * seed.radius < gap; });
    EXPECT_GE(static_cast<double>(one_sided), 0.95 * static_cast<double>(seeds.size()));
}

TEST(Seeding, KeepsTheRadiusWhereFewPointsAreLeft) {
    const Points points = test::make_thin_plate({.points = 300}, 0.12).points;
    for (const Frame& seed : seeds_of(points, 0.003)) EXPECT_EQ(seed.radius, kRadius);
}

TEST(Seeding, DoesNotDependOnTheThreads) {
    const Points points = test::make_thin_plate({.points = 20000, .noise = 0.01}).points;
    const std::vector<Frame> one = seeds_of(points, 0.015, 1);
    const std::vector<Frame> five = seeds_of(points, 0.015, 5);
    ASSERT_EQ(one.size(), five.size());
    for (std::size_t j = 0; j < one.size(); ++j) {
        EXPECT_EQ(one[j].centre, five[j].centre);
        EXPECT_EQ(one[j].radius, five[j].radius);
    }
}

TEST(Seeding, CoversEveryPointWithinTheSpacingOfASeed) {
    // A solid block suits no radius: there, the smallest is taken.
    const std::vector<Points> clouds = {
        test::make_thin_plate({.points = 12000, .noise = 0.001}, 0.4 * kRadius).points,
        test::make_thin_plate({.points = 12000, .noise = 0.001}, kRadius).points,
        test::random_box(20000, 3, 0.0, 0.6)};
    for (const Points& points : clouds) {
        const std::vector<Frame> seeds = seeds_of(points, 0.0015);
        for (Eigen::Index i = 0; i < points.cols(); i += 5) {
            ASSERT_TRUE(std::ranges::any_of(seeds,
                                            [&](const Frame& seed) {
                                                return (points.col(i) - seed.centre).norm() <=
                                                       0.5 * seed.radius * (1 + 1e-9);
                                            }))
                << "point " << i << " of " << points.cols();
        }
    }
}

TEST(Seeding, KeepsSeedsOfOneSizeApart) {
    const Points points = test::make_thin_plate({.points = 12000, .noise = 0.002}).points;
    const std::vector<Frame> seeds = seeds_of(points, 0.003);
    std::set<double> sizes;
    for (const Frame& a : seeds) {
        sizes.insert(a.radius);
        for (const Frame& b : seeds) {
            if (&a == &b || a.radius != b.radius) continue;
            ASSERT_GE((a.centre - b.centre).norm(), 0.5 * a.radius * (1 - 1e-9));
        }
    }
    EXPECT_GT(sizes.size(), 1U);
}

}  // namespace
}  // namespace lpf
