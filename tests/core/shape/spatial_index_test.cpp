#include "core/shape/spatial_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/base/parallel.h"
#include "core/base/random.h"
#include "tests/core/clouds.h"

namespace lpf {
namespace {

using Neighbours = std::vector<SpatialIndex::Neighbour>;
using Eigen::Vector3d;

std::vector<double> squared_distances(const Points& points, const Vector3d& query) {
    std::vector<double> distances;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        distances.push_back((points.col(i) - query).squaredNorm());
    }
    return distances;
}

/// Points of the cloud, points beside them, and one far away.
std::vector<Vector3d> queries_for(const Points& points) {
    std::vector<Vector3d> queries = {Vector3d(0.1, 0.2, 0.3), Vector3d(-1e4, 50, 2e5)};
    Random random(11);
    const auto n = static_cast<std::uint64_t>(points.cols());
    for (int i = 0; n > 0 && i < 10; ++i) {
        const Vector3d point = points.col(static_cast<Eigen::Index>(random.below(n)));
        queries.push_back(point);
        queries.push_back(point + 0.1 * Vector3d(random.normal(), random.normal(), 0));
    }
    return queries;
}

/// Rounding of a squared distance between coordinates of this size.
double tolerance(const Points& points, double squared) {
    const double size = points.cols() ? points.cwiseAbs().maxCoeff() : 0;
    return 1e-9 * squared + 1e-14 * size;
}

class SpatialIndexOn : public testing::TestWithParam<test::NamedCloud> {
protected:
    const Points& points = GetParam().points;
    const SpatialIndex index{points};
};

TEST_P(SpatialIndexOn, NearestAgreesWithBruteForce) {
    for (const Vector3d& query : queries_for(points)) {
        const std::vector<double> all = squared_distances(points, query);
        std::vector<double> sorted = all;
        std::sort(sorted.begin(), sorted.end());
        for (const std::size_t k : {1U, 2U, 9U, 40U}) {
            const Neighbours found = index.nearest(query, k);
            ASSERT_EQ(found.size(), std::min(k, sorted.size()));
            std::set<std::uint32_t> distinct;
            for (std::size_t i = 0; i < found.size(); ++i) {
                const double squared = found[i].squared_distance;
                ASSERT_NEAR(squared, sorted[i], tolerance(points, squared));
                ASSERT_NEAR(squared, all[found[i].index], tolerance(points, squared));
                distinct.insert(found[i].index);
            }
            ASSERT_EQ(distinct.size(), found.size());
        }
    }
}

TEST_P(SpatialIndexOn, WithinAgreesWithBruteForce) {
    for (const Vector3d& query : queries_for(points)) {
        const std::vector<double> all = squared_distances(points, query);
        for (const double radius : {0.0, 0.1, 0.7, 3.3}) {
            const double squared = radius * radius;
            std::set<std::uint32_t> found;
            for (const auto& neighbour : index.within(query, radius)) {
                ASSERT_TRUE(found.insert(neighbour.index).second) << "found twice";
                ASSERT_NEAR(neighbour.squared_distance, all[neighbour.index],
                            tolerance(points, squared));
            }
            for (std::uint32_t i = 0; i < all.size(); ++i) {
                if (all[i] < squared - tolerance(points, squared)) {
                    ASSERT_TRUE(found.contains(i));
                }
                if (all[i] > squared + tolerance(points, squared)) {
                    ASSERT_FALSE(found.contains(i));
                }
            }
        }
    }
}

TEST_P(SpatialIndexOn, AskingForMoreThanThereAreGivesAll) {
    const Neighbours found = index.nearest(Vector3d(0.5, 0.5, 0.5), 100000);
    EXPECT_EQ(found.size(), static_cast<std::size_t>(points.cols()));
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return a.squared_distance < b.squared_distance;
    }));
}

TEST_P(SpatialIndexOn, AskingForNoneGivesNone) {
    EXPECT_TRUE(index.nearest(Vector3d::Zero(), 0).empty());
    EXPECT_TRUE(index.within(Vector3d::Zero(), -1.0).empty());
}

INSTANTIATE_TEST_SUITE_P(Clouds, SpatialIndexOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(SpatialIndex, WithinIncludesThePointsAtExactlyTheRadius) {
    Points points(3, 3);
    points << 0, 3, 0, 0, 4, 5, 0, 0, 0.001;
    EXPECT_EQ(SpatialIndex(points).within(Vector3d::Zero(), 5.0).size(), 2U);
}

TEST(SpatialIndex, BuffersAreOverwrittenNotAppendedTo) {
    const SpatialIndex index(test::random_box(100, 1));
    Neighbours found(7);
    index.nearest(Vector3d(0.5, 0.5, 0.5), 3, found);
    EXPECT_EQ(found.size(), 3U);
    index.within(Vector3d(9, 9, 9), 0.1, found);
    EXPECT_TRUE(found.empty());
}

TEST(SpatialIndex, OutlivesThePointsItWasMadeFrom) {
    auto points = std::make_unique<Points>(test::random_box(200, 2));
    const Vector3d query = points->col(17);
    const SpatialIndex index(*points);
    points.reset();
    EXPECT_EQ(index.nearest(query, 1).front().index, 17U);
}

TEST(SpatialIndex, WorksAfterAMove) {
    SpatialIndex first(test::random_box(50, 3));
    const SpatialIndex second = std::move(first);
    EXPECT_EQ(second.nearest(Vector3d::Zero(), 5).size(), 5U);
}

TEST(SpatialIndex, SeparatesPointsAMillimetreApartAtMapCoordinates) {
    Points points(3, 2);
    points << 3.5e7, 3.5e7 + 0.001, 5.6e6, 5.6e6, 100, 100;
    const SpatialIndex index(points);
    EXPECT_EQ(index.nearest(points.col(1), 1).front().index, 1U);
    EXPECT_NEAR(index.nearest(points.col(0), 2).back().squared_distance, 1e-6, 1e-11);
}

TEST(SpatialIndex, ManyThreadsMaySearchAtOnce) {
    const Points points = test::random_box(2000, 4);
    const SpatialIndex index(points);
    std::vector<std::uint32_t> nearest(2000);
    parallel_for({.threads = 8}, 2000, 10, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) {
            nearest[i] = index.nearest(points.col(static_cast<Eigen::Index>(i)), 1)[0].index;
        }
    });
    for (std::uint32_t i = 0; i < 2000; ++i) ASSERT_EQ(nearest[i], i);
}

}  // namespace
}  // namespace lpf
