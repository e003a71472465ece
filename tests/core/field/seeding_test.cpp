#include "core/field/seeding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/field/seed_sizes.h"
#include "core/shape/poisson_sampling.h"
#include "tests/core/clouds.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr double kRadius = 0.15;

SeedingParams params_for(double noise) {
    return {.radius = kRadius,
            .spacing = 0.5,
            .noise = noise,
            .adapt_radius = noise > 0,
            .random_seed = 7};
}

PointGrid grid_of(const Points& points) { return {points, 0.55 * kRadius}; }

Seeds place(const Points& points, double noise, int threads = 1) {
    const PointGrid grid = grid_of(points);
    return place_seeds(points, grid, params_for(noise), {.threads = threads});
}

std::vector<Frame> seeds_of(const Points& points, double noise) {
    return place(points, noise).frames;
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

TEST(Seeding, LpfsThatAdaptAreNoSmallerThanAskedFor) {
    const double noise = 0.01;
    const Points points = test::make_cube({.points = 20000, .noise = noise}).points;
    const PointGrid grid = grid_of(points);
    SeedingParams params = params_for(noise);
    const auto smallest = [&] {
        double least = 1e300;
        for (const Frame& seed : place_seeds(points, grid, params, {.threads = 2}).frames) {
            least = std::min(least, seed.radius);
        }
        return least;
    };
    EXPECT_GE(smallest(), least_radius(noise));
    EXPECT_LT(smallest(), 0.7 * kRadius);
    params.least_radius = 0.7 * kRadius;
    EXPECT_GE(smallest(), 0.7 * kRadius * (1 - 1e-12));
}

class SeedingOf : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(SeedingOf, CoversEveryPointWithinTheSpacing) {
    const Points& points = GetParam().points;
    const std::vector<Frame> seeds = seeds_of(points, 0.0);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        ASSERT_LE(least_share(points.col(i), seeds), 0.5 * (1 + 1e-9));
    }
}

TEST_P(SeedingOf, PutsEveryPointUnderADiskWhateverTheNoise) {
    const Points& points = GetParam().points;
    for (const double noise : {1e-6, 0.02}) {
        const std::vector<Frame> seeds = seeds_of(points, noise);
        for (Eigen::Index i = 0; i < points.cols(); ++i) {
            ASSERT_LE(least_share(points.col(i), seeds), 1.0) << noise << ", point " << i;
        }
    }
}

TEST_P(SeedingOf, PutsSeedsOfOneSizeApart) {
    const std::vector<Frame> seeds = seeds_of(GetParam().points, 0.0);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE((seeds[i].centre - seeds[j].centre).norm(), 0.5 * kRadius);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, SeedingOf, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Seeding, WithoutNoiseIsThePoissonDiskSubset) {
    const Points points = test::make_sphere({.points = 4000, .noise = 0.02}).points;
    const PointGrid grid = grid_of(points);
    std::vector<std::uint32_t> all(grid.size());
    std::iota(all.begin(), all.end(), 0U);
    std::vector<Eigen::Vector3d> expected;
    for (const std::uint32_t i : poisson_disk_subset(grid, all, 0.5 * kRadius, 7, {})) {
        expected.emplace_back(points.col(grid.order()[i]));
    }
    const std::vector<Frame> seeds = seeds_of(points, 0.0);
    ASSERT_EQ(seeds.size(), expected.size());
    for (const Frame& seed : seeds) {
        EXPECT_EQ(seed.radius, kRadius);
        EXPECT_NE(std::ranges::find(expected, seed.centre), expected.end());
    }
}

TEST(Seeding, TakesLargeRadiiOnAPlane) {
    const Points points = test::make_plane({.points = 20000, .noise = 0.02}).points;
    const std::vector<Frame> seeds = seeds_of(points, 0.02);
    const auto smaller =
        std::ranges::count_if(seeds, [](const Frame& seed) { return seed.radius < kRadius; });
    EXPECT_LE(static_cast<double>(smaller), 0.1 * static_cast<double>(seeds.size()));
}

TEST(Seeding, TakesLargerRadiiWhereThereIsMoreNoise) {
    Points points = test::make_plane({.points = 40000}).points;
    points.row(2) = test::random_box(40000, 3, -0.01, 0.01).row(2);
    Points places(3, 2);
    places << -0.5, 0.5, 0, 0, 0, 0;
    SeedingParams params = params_for(0.006);
    params.noise_map = NoiseMap(places, {1.0, 20.0});
    const Seeds seeds = place_seeds(points, grid_of(points), params, {.threads = 2});
    for (std::size_t j = 0; j < seeds.frames.size(); ++j) {
        const Frame& frame = seeds.frames[j];
        if (std::abs(frame.centre.x()) < 0.5) continue;
        const double noise = static_cast<double>(seeds.pieces[j].noise) * frame.radius;
        EXPECT_NEAR(noise, frame.centre.x() < 0 ? 0.006 : 0.12, 0.06);
        EXPECT_GE(frame.radius, frame.centre.x() < 0 ? 0.0 : 1.4 * kRadius);
    }
}

TEST(Seeding, TakesSmallRadiiWhereTheShapeBends) {
    const Points bent = test::make_sphere({.points = 40000, .noise = 0.05}).points * 0.12;
    const Points flat = test::make_plane({.points = 40000, .noise = 0.006}).points;
    const auto mean_radius = [](const Points& points) {
        double sum = 0;
        const std::vector<Frame> seeds = seeds_of(points, 0.006);
        for (const Frame& seed : seeds) sum += seed.radius;
        return sum / static_cast<double>(seeds.size());
    };
    EXPECT_LT(mean_radius(bent), 0.7 * mean_radius(flat));
}

/// Members of a seed's piece, as indices into the grid's order.
TargetArea members_of(const Frame& seed, const Piece& piece, const PointGrid& grid) {
    TargetArea target;
    grid.gather(seed.centre, seed.radius, 1.1F, target);
    Frame frame = seed;
    frame.origin = piece.origin;
    frame.axes = piece.axes;
    target.to_frame(frame);
    flatten(piece, target);
    keep_members(piece, 1.0F, target);
    return target;
}

TEST(Seeding, KeepsToOneSheetOfAPlateThatIsThinnerThanTheRadius) {
    const Points points = test::make_thin_plate({.points = 40000, .noise = 0.005}, 0.06).points;
    const PointGrid grid(points, 0.55 * kRadius);
    const Seeds seeds = place(points, 0.005);
    double members = 0;
    double strangers = 0;
    for (std::size_t j = 0; j < seeds.frames.size(); ++j) {
        if (std::abs(seeds.pieces[j].axes(2, 2)) < 0.9F) continue;  // on a narrow side
        const TargetArea target = members_of(seeds.frames[j], seeds.pieces[j], grid);
        double above = 0;
        for (std::size_t i = 0; i < target.size; ++i) above += grid.point(target.index[i]).z() > 0;
        const auto all = static_cast<double>(target.size);
        members += all;
        strangers += std::min(above, all - above);
    }
    ASSERT_GT(members, 0);
    EXPECT_LT(strangers, 0.02 * members);
}

TEST(Seeding, DoesNotDependOnTheThreads) {
    const Points points = test::make_thin_plate({.points = 20000, .noise = 0.01}).points;
    const Seeds one = place(points, 0.01, 1);
    const Seeds five = place(points, 0.01, 5);
    ASSERT_EQ(one.frames.size(), five.frames.size());
    for (std::size_t j = 0; j < one.frames.size(); ++j) {
        EXPECT_EQ(one.frames[j].centre, five.frames[j].centre);
        EXPECT_EQ(one.frames[j].radius, five.frames[j].radius);
        EXPECT_TRUE(std::ranges::equal(one.pieces[j].coefficients, five.pieces[j].coefficients));
    }
}

}  // namespace
}  // namespace lpf
