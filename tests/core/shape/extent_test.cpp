#include "core/shape/extent.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/random.h"

namespace lpf {
namespace {

/// More than two chunks.
Points random_points() {
    Random random(3);
    Points points(3, 3 * static_cast<Eigen::Index>(kPointsPerChunk) + 7);
    for (double& value : points.reshaped()) value = random.normal();
    return points;
}

TEST(Extent, BoxReachesFromTheLowestToTheHighestForAnyThreads) {
    const Points points = random_points();
    for (const int threads : {1, 2, 5}) {
        const Eigen::AlignedBox3d box = bounding_box(points, {.threads = threads});
        EXPECT_EQ(box.min(), points.rowwise().minCoeff());
        EXPECT_EQ(box.max(), points.rowwise().maxCoeff());
    }
    EXPECT_TRUE(bounding_box(Points(3, 0)).isEmpty());
}

TEST(Extent, CentreIsFiniteWhereverThePointsAre) {
    Points points(3, 2);
    points.col(0).setConstant(1.5e308);
    points.col(1).setConstant(1.7e308);
    for (const double coordinate : centre_of(points)) EXPECT_DOUBLE_EQ(coordinate, 1.6e308);
    EXPECT_EQ(centre_of(Points(3, 0)), Eigen::Vector3d::Zero());
}

TEST(Extent, SelectedPointsComeInTheOrderOfTheirNumbers) {
    const Points points = random_points();
    std::vector<std::uint32_t> numbers;
    for (Eigen::Index i = points.cols() - 1; i >= 0; i -= 3) {
        numbers.push_back(static_cast<std::uint32_t>(i));
    }
    const Points some = selected(points, numbers, {.threads = 2});
    ASSERT_EQ(static_cast<std::size_t>(some.cols()), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        EXPECT_EQ(some.col(static_cast<Eigen::Index>(i)), points.col(numbers[i]));
    }
    EXPECT_EQ(selected(points, {}).cols(), 0);
}

TEST(Extent, OneCoordinateThatIsNotFiniteIsFound) {
    Points points = random_points();
    EXPECT_TRUE(all_finite(points, {.threads = 2}));
    EXPECT_TRUE(all_finite(Points(3, 0)));
    for (const double value :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()}) {
        double& last = points(2, points.cols() - 1);
        last = value;
        EXPECT_FALSE(all_finite(points, {.threads = 2})) << value;
        last = std::numeric_limits<double>::max();
        EXPECT_TRUE(all_finite(points, {.threads = 2}));
    }
}

}  // namespace
}  // namespace lpf
