#include "core/shape/hash_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "core/shape/point_cloud.h"
#include "tests/core/clouds.h"

namespace lpf {
namespace {

using Numbers = std::set<std::uint32_t>;

HashGrid grid_of(const Points& points, double reach) {
    const Eigen::Vector3d low = points.rowwise().minCoeff();
    HashGrid grid(low, (points.rowwise().maxCoeff() - low).maxCoeff(), reach);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        EXPECT_EQ(grid.add(points.col(i)), static_cast<std::uint32_t>(i));
    }
    return grid;
}

Numbers near(const HashGrid& grid, const Eigen::Vector3d& at) {
    Numbers found;
    grid.for_each_near(at, [&](std::uint32_t i, const Eigen::Vector3d&) {
        EXPECT_TRUE(found.insert(i).second) << "visited twice";
        return true;
    });
    return found;
}

Numbers brute_force(const Points& points, const Eigen::Vector3d& at, double reach) {
    Numbers found;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if ((points.col(i) - at).squaredNorm() <= reach * reach) {
            found.insert(static_cast<std::uint32_t>(i));
        }
    }
    return found;
}

class HashGridOn : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(HashGridOn, FindsWhatBruteForceFinds) {
    const Points& points = GetParam().points;
    if (points.cols() == 0) return;
    for (const double reach : {0.05, 0.3, 1.0, 2.5}) {
        const HashGrid grid = grid_of(points, reach);
        for (Eigen::Index i = 0; i < points.cols(); i += 1 + points.cols() / 60) {
            const Eigen::Vector3d beside = points.col(i) + Eigen::Vector3d(0.4, -0.3, 0.2) * reach;
            ASSERT_EQ(near(grid, points.col(i)), brute_force(points, points.col(i), reach));
            ASSERT_EQ(near(grid, beside), brute_force(points, beside, reach));
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, HashGridOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(HashGrid, FindsAllAfterItHasGrownManyTimes) {
    const Points points = test::random_box(6000, 3);
    const double reach = 0.02;  // nearly every point has a cell of its own
    const HashGrid grid = grid_of(points, reach);
    for (Eigen::Index i = 0; i < points.cols(); i += 7) {
        ASSERT_EQ(near(grid, points.col(i)), brute_force(points, points.col(i), reach));
    }
}

TEST(HashGrid, ReachesItsLimitAndNoFurther) {
    const Points points = test::lattice(5);
    const HashGrid grid = grid_of(points, 1.0);
    EXPECT_EQ(near(grid, Eigen::Vector3d(2, 2, 2)).size(), 7U) << "itself and six at distance 1";
}

TEST(HashGrid, StopsWhenTheVisitorHasSeenEnough) {
    const HashGrid grid = grid_of(test::lattice(3), 5.0);
    int visits = 0;
    grid.for_each_near({1, 1, 1},
                       [&](std::uint32_t, const Eigen::Vector3d&) { return ++visits < 4; });
    EXPECT_EQ(visits, 4);
}

}  // namespace
}  // namespace lpf
