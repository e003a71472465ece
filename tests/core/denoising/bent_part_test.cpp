#include "core/denoising/bent_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/denoising/near_groups.h"
#include "tests/core/clouds.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr double kNoise = 0.05;

BentPart bent_part(const Points& shape, const Region& region = {}, double margin = 0.0) {
    return find_bent_part(shape, kNoise, region, margin, {.threads = 2});
}

std::vector<std::uint8_t> flags(const BentPart& part, std::size_t points) {
    std::vector<std::uint8_t> is_bent(points, 0);
    for (const std::uint32_t place : part.bent) is_bent[part.points[place]] = 1;
    return is_bent;
}

TEST(BentPart, IsWhatLiesAtEdges) {
    const test::TestShape cube = test::make_cube({.points = 40000, .seed = 2});
    const auto is_bent = flags(bent_part(cube.clean), 40000);
    for (Eigen::Index i = 0; i < cube.clean.cols(); ++i) {
        const double to_edge = test::distance_to_pieces(cube.edges, cube.clean.col(i));
        ASSERT_TRUE(to_edge >= 0.5 * kNoise || is_bent[static_cast<std::size_t>(i)]);
        ASSERT_FALSE(to_edge > 8 * kNoise && is_bent[static_cast<std::size_t>(i)]);
    }
}

TEST(BentPart, HoldsAllThatMattersOnce) {
    const test::TestShape cube = test::make_cube({.points = 40000, .seed = 2});
    const BentPart part = bent_part(cube.clean);
    std::vector<std::uint32_t> points = part.points;
    std::ranges::sort(points);
    EXPECT_TRUE(std::ranges::adjacent_find(points) == points.end());
    EXPECT_TRUE(std::ranges::is_sorted(part.bent));
    EXPECT_GT(part.points.size(), part.bent.size());
    EXPECT_LT(part.bent.back(), part.points.size());
}

TEST(BentPart, IsTheBorderOfASheetAndTheEndOfALine) {
    const test::TestShape plane = test::make_plane({.points = 40000, .seed = 2});
    const auto at_border = flags(bent_part(plane.clean), 40000);
    for (Eigen::Index i = 0; i < plane.clean.cols(); ++i) {
        const double within = 1 - plane.clean.col(i).cwiseAbs().maxCoeff();
        ASSERT_TRUE(within >= 0.5 * kNoise || at_border[static_cast<std::size_t>(i)]);
        ASSERT_FALSE(within > 6 * kNoise && at_border[static_cast<std::size_t>(i)]);
    }
    const test::TestShape line = test::make_line({.points = 4000, .seed = 2});
    const auto at_end = flags(bent_part(line.clean), 4000);
    for (Eigen::Index i = 0; i < line.clean.cols(); ++i) {
        const double within = 1 - std::abs(line.clean(0, i));
        ASSERT_TRUE(within >= 0.5 * kNoise || at_end[static_cast<std::size_t>(i)]);
        ASSERT_FALSE(within > 6 * kNoise && at_end[static_cast<std::size_t>(i)]);
    }
}

TEST(BentPart, IsLookedForInTheRegionAlone) {
    const test::TestShape cube = test::make_cube({.points = 40000, .seed = 2});
    const Box corner{Eigen::Vector3d::Constant(0.9), Eigen::Vector3d::Constant(1.1)};
    const BentPart part = bent_part(cube.clean, {corner}, 2 * kNoise);
    EXPECT_FALSE(part.bent.empty());
    for (const std::uint32_t place : part.bent) {
        EXPECT_LT(corner.distance_to(cube.clean.col(part.points[place])), 6 * kNoise);
    }
}

TEST(BentPart, IsNothingWhereFewPointsAreNear) {
    const test::TestShape cube = test::make_cube({.points = 500, .seed = 2});
    EXPECT_TRUE(bent_part(cube.clean).points.empty());
    EXPECT_LT(bent_part(cube.clean).near, 24);
}

TEST(BentPart, OneInSoMany) {
    const Points points = test::random_box(10, 1);
    EXPECT_EQ(one_in(1, points), points);
    const Points third = one_in(3, points);
    ASSERT_EQ(third.cols(), 4);
    EXPECT_EQ(third.col(3), points.col(9));
    EXPECT_EQ(stride_to(50, 20), 1U);
    EXPECT_EQ(stride_to(50, 99), 1U);
    EXPECT_EQ(stride_to(50, 100), 2U);
}

TEST(NearGroups, HoldAllPointsInTheirOrder) {
    const Points points = test::random_box(3000, 5);
    const double side = 0.4;
    const auto groups = near_groups(
        3000, side, [&](std::size_t i) { return points.col(static_cast<Eigen::Index>(i)); },
        {.threads = 2});
    std::size_t at = 0;
    for (const NearGroup& group : groups) {
        ASSERT_EQ(group.begin, at);
        ASSERT_LT(group.begin, group.end);
        at = group.end;
        for (std::size_t i = group.begin; i < group.end; ++i) {
            const double distance =
                (points.col(static_cast<Eigen::Index>(i)) - group.centre).norm();
            ASSERT_LE(distance, group.radius * (1 + 1e-12));
        }
        ASSERT_LE(group.radius, 0.5 * std::sqrt(3.0) * side * (1 + 1e-12));
    }
    EXPECT_EQ(at, 3000U);
    EXPECT_TRUE(near_groups(0, side, [&](std::size_t) { return points.col(0); }, {}).empty());
}

}  // namespace
}  // namespace lpf
