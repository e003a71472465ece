#include "core/shape/tiling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stop_token>

#include "core/base/error.h"
#include "tests/core/clouds.h"

namespace lpf {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::uint32_t> numbers(std::span<const std::uint32_t> points) {
    return {points.begin(), points.end()};
}

std::vector<std::uint32_t> points_near(const Points& points, const Box& box, double margin) {
    std::vector<std::uint32_t> near;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::Vector3d p = points.col(i);
        const bool inside = (p.array() >= box.low.array() - margin).all() &&
                            (p.array() < box.high.array() + margin).all();
        if (inside) near.push_back(static_cast<std::uint32_t>(i));
    }
    return near;
}

class TilingOf : public testing::TestWithParam<test::NamedCloud> {
protected:
    const Points& points = GetParam().points;
    const PointsInMemory source{points};
    const Sketch sketch = make_sketch(source, {});
};

TEST_P(TilingOf, EveryPointLiesInOneBox) {
    const Partition partition(sketch, 20);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const auto holds = [&](const Box& box) { return box.holds(points.col(i)); };
        EXPECT_EQ(std::ranges::count_if(partition.boxes(), holds), 1);
    }
}

TEST_P(TilingOf, ATileHasThePointsInAndNearItsBox) {
    const Partition partition(sketch, 50);
    const double margin = 0.1 * (sketch.high - sketch.low).maxCoeff();
    const Tiling tiling(source, partition, margin, {.threads = 2});
    ASSERT_EQ(tiling.size(), partition.boxes().size());
    for (std::size_t tile = 0; tile < tiling.size(); ++tile) {
        EXPECT_EQ(numbers(tiling.points(tile)),
                  points_near(points, partition.boxes()[tile], margin));
    }
}

TEST_P(TilingOf, AnExcerptHasThePointsInAndNearItsBoxes) {
    const Partition partition(sketch, 30);
    const Excerpt excerpt = make_excerpt(source, partition, 3, 0.01, {.threads = 2});
    EXPECT_EQ(excerpt.boxes.size(), std::min<std::size_t>(3, partition.boxes().size()));
    std::set<std::uint32_t> near;
    for (const Box& box : excerpt.boxes)
        near.merge([&] {
            const auto of_box = points_near(points, box, 0.01);
            return std::set<std::uint32_t>(of_box.begin(), of_box.end());
        }());
    EXPECT_EQ(excerpt.points, std::vector<std::uint32_t>(near.begin(), near.end()));
}

INSTANTIATE_TEST_SUITE_P(Clouds, TilingOf, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Tiling, BoxesHoldAboutAsManyPointsAsAskedFor) {
    const Points points = test::random_box(20'000, 5);
    const PointsInMemory source(points);
    const Partition partition(make_sketch(source, {}), 1000);
    const Tiling tiling(source, partition, 0.0, {});
    EXPECT_EQ(tiling.size(), 32U);
    for (std::size_t tile = 0; tile < tiling.size(); ++tile) {
        EXPECT_LE(tiling.points(tile).size(), 1000U);
        EXPECT_GE(tiling.points(tile).size(), 500U);
    }
}

TEST(Tiling, PointsOnEachOtherAreNotCutForEver) {
    Points points = Points::Zero(3, 5000);
    points.col(17) << 1, 0, 0;
    const PointsInMemory source(points);
    const Partition partition(make_sketch(source, {}), 10);
    EXPECT_EQ(partition.boxes().size(), 2U);
}

TEST(Tiling, PointsThatAreNotFiniteLieInNoTile) {
    Points points = test::random_box(3000, 1);
    points.col(5).x() = kNan;
    points.col(2999).z() = -kInfinity;
    const PointsInMemory source(points);
    const Sketch sketch = make_sketch(source, {});
    EXPECT_EQ(sketch.of, 2998U);
    EXPECT_TRUE((sketch.low.array() >= 0).all() && (sketch.high.array() <= 1).all());
    const Tiling tiling(source, Partition(sketch, 500), 0.0, {});
    std::size_t total = 0;
    for (std::size_t tile = 0; tile < tiling.size(); ++tile) {
        for (const std::uint32_t i : tiling.points(tile)) EXPECT_TRUE(i != 5 && i != 2999);
        total += tiling.points(tile).size();
    }
    EXPECT_EQ(total, 2998U);
}

TEST(Tiling, ACloudOfNoPointsIsOneEmptyTile) {
    const Points none(3, 0);
    const PointsInMemory source(none);
    const Tiling tiling(source, Partition(make_sketch(source, {}), 100), 1.0, {});
    ASSERT_EQ(tiling.size(), 1U);
    EXPECT_TRUE(tiling.points(0).empty());
}

TEST(Tiling, DoesNotDependOnTheNumberOfThreads) {
    const Points points = test::random_box(50'000, 7);
    const PointsInMemory source(points);
    const Partition partition(make_sketch(source, {}), 3000);
    const Tiling one(source, partition, 0.02, {.threads = 1});
    const Tiling five(source, partition, 0.02, {.threads = 5});
    for (std::size_t tile = 0; tile < one.size(); ++tile) {
        EXPECT_EQ(numbers(one.points(tile)), numbers(five.points(tile)));
    }
}

TEST(Tiling, AsksWhetherToStop) {
    const Points points = test::random_box(20'000, 7);
    const PointsInMemory source(points);
    std::stop_source stop;
    stop.request_stop();
    EXPECT_THROW((void)make_sketch(source, {.stop = stop.get_token()}), Error);
}

}  // namespace
}  // namespace lpf
