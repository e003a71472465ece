#include "core/shape/outliers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/core/clouds.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

using Flags = std::vector<std::uint8_t>;

int count(const Flags& flags) { return std::accumulate(flags.begin(), flags.end(), 0); }

Points with_point(const Points& points, const Eigen::Vector3d& point) {
    Points more(3, points.cols() + 1);
    more << points, point;
    return more;
}

TEST(Outliers, FindsOnePointFarFromTheRest) {
    const Points points = with_point(test::random_box(1000, 1), {5, 5, 5});
    const Flags flags = find_outliers(points, 4, {});
    ASSERT_EQ(flags.size(), 1001U);
    EXPECT_EQ(flags.back(), 1);
    EXPECT_EQ(count(flags), 1);
}

TEST(Outliers, FindsTheIsolatedPointsOfAPlane) {
    const test::TestShape shape = test::make_isolated_points({.points = 5000});
    const Flags flags = find_outliers(shape.points, 4, {});
    int missed = 0;
    int wrong = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
        missed += shape.outlier[i] && !flags[i];
        wrong += !shape.outlier[i] && flags[i];
    }
    EXPECT_LE(missed, 5);
    EXPECT_LE(wrong, 10);
}

TEST(Outliers, LeavesARegularLatticeAloneToItsCorners) {
    EXPECT_EQ(count(find_outliers(test::lattice(10), 3, {})), 0);
}

TEST(Outliers, LeavesTheEndsOfALineAlone) {
    Points points = Points::Zero(3, 200);
    points.row(0).setLinSpaced(0, 1);
    EXPECT_EQ(count(find_outliers(points, 3, {})), 0);
}

TEST(Outliers, LeavesASlowChangeOfDensityAlone) {
    Points points = test::random_box(5000, 3);
    points.row(0) = points.row(0).array().exp().matrix() * 3;  // spacing grows by e
    EXPECT_LE(count(find_outliers(points, 4, {})), 5);
}

TEST(Outliers, JudgesNobodyBelow32Points) {
    Points points = test::random_box(31, 4);
    points(0, 0) = 1e6;
    EXPECT_EQ(count(find_outliers(points, 1, {})), 0);
    EXPECT_EQ(count(find_outliers(with_point(points, {0, 0, 0}), 3, {})), 1);
}

TEST(Outliers, AHeapOfDuplicatesIsNotIsolatedAndDoesNotHideOthers) {
    Points points = test::random_box(500, 5);
    points.leftCols(300).setConstant(0.5);
    points.col(499) = Eigen::Vector3d(40, 0, 0);
    const Flags flags = find_outliers(points, 4, {});
    EXPECT_EQ(count(Flags(flags.begin(), flags.begin() + 300)), 0);
    EXPECT_EQ(flags[499], 1);
}

TEST(Outliers, DoesNotDependOnTheNumberOfThreads) {
    const Points points = test::make_isolated_points({.points = 9000}).points;
    const Flags one = find_outliers(points, 3, {.threads = 1});
    EXPECT_EQ(find_outliers(points, 3, {.threads = 2}), one);
    EXPECT_EQ(find_outliers(points, 3, {.threads = 8}), one);
}

class OutliersOn : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(OutliersOn, GivesOneFlagForEachPointAndNoneForALooseLimit) {
    const Points& points = GetParam().points;
    const Flags flags = find_outliers(points, 1e3, {});
    EXPECT_EQ(flags.size(), static_cast<std::size_t>(points.cols()));
    EXPECT_EQ(count(flags), 0);
}

TEST_P(OutliersOn, DuplicatesAgreeWithBruteForce) {
    const Points& points = GetParam().points;
    const Flags flags = find_duplicates(points);
    ASSERT_EQ(flags.size(), static_cast<std::size_t>(points.cols()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        bool repeats = false;
        for (Eigen::Index j = 0; j < i; ++j) repeats |= points.col(i) == points.col(j);
        ASSERT_EQ(flags[static_cast<std::size_t>(i)], repeats) << "point " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, OutliersOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Duplicates, MinusZeroEqualsZero) {
    Points points(3, 3);
    points << 0.0, -0.0, 0.0, 1, 1, 1, -0.0, 0.0, 1e-300;
    EXPECT_EQ(find_duplicates(points), (Flags{0, 1, 0}));
}

TEST(Duplicates, KeepTheFirstOfEachPlace) {
    Points points(3, 5);
    points << 2, 1, 2, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0;
    EXPECT_EQ(find_duplicates(points), (Flags{0, 0, 1, 1, 1}));
}

/// The definition: logarithms of the mean distances to eight others, with a robust deviation.
std::vector<std::uint8_t> outliers_by_definition(const Points& points, double deviations) {
    std::vector<double> logs;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        std::vector<double> distances;
        for (Eigen::Index k = 0; k < points.cols(); ++k) {
            if (k != i) distances.push_back((points.col(i) - points.col(k)).norm());
        }
        std::partial_sort(distances.begin(), distances.begin() + 8, distances.end());
        logs.push_back(std::log(std::accumulate(distances.begin(), distances.begin() + 8, 0.0)));
    }
    const auto median = [](std::vector<double> values) {
        std::sort(values.begin(), values.end());
        return values[values.size() / 2];
    };
    const double centre = median(logs);
    std::vector<double> off;
    for (const double value : logs) off.push_back(std::abs(value - centre));
    const double limit = centre + deviations * std::max(0.2, 1.4826 * median(off));
    std::vector<std::uint8_t> result;
    for (const double value : logs) result.push_back(value > limit);
    return result;
}

TEST(Outliers, AgreeWithTheirDefinition) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Points points = test::random_box(300, seed, -1, 1);
        const auto power = static_cast<double>(seed);
        for (auto column : points.colwise()) column *= std::pow(column.norm(), power);
        for (const double deviations : {0.5, 1.0, 1.5, 2.0, 3.0}) {
            EXPECT_EQ(find_outliers(points, deviations, {}),
                      outliers_by_definition(points, deviations))
                << "deviations " << deviations << ", power " << power;
        }
    }
}

TEST(Outliers, AreSeenBesideAHeapOfEqualPoints) {
    Points points(3, 161);
    points.leftCols(100).colwise() = Eigen::Vector3d(0.5, 0.5, 0.5);  // most of the cloud
    points.middleCols(100, 60) = test::random_box(60, 5);
    points.col(160) << 9, 9, 9;
    const std::vector<std::uint8_t> found = find_outliers(points, 4.0, {});
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), 1);
    EXPECT_EQ(found.back(), 1);
}

}  // namespace
}  // namespace lpf
