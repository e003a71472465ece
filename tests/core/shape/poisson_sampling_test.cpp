#include "core/shape/poisson_sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "tests/core/clouds.h"

namespace lpf {
namespace {

using Indices = std::vector<std::uint32_t>;

double distance(const Points& points, std::uint32_t a, std::uint32_t b) {
    return (points.col(a) - points.col(b)).norm();
}

void expect_poisson_disk(const Points& points, const Indices& chosen, double spacing) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE(distance(points, chosen[i], chosen[j]), spacing);
        }
    }
    for (std::uint32_t i = 0; i < points.cols(); ++i) {
        ASSERT_TRUE(std::any_of(
            chosen.begin(), chosen.end(),
            [&](std::uint32_t c) { return c == i || distance(points, c, i) < spacing; }))
            << "point " << i << " is not covered";
    }
}

class PoissonDiskOn : public testing::TestWithParam<test::NamedCloud> {
protected:
    const Points& points = GetParam().points;
};

TEST_P(PoissonDiskOn, KeepsTheDistanceAndCoversEveryPoint) {
    for (const double spacing : {1e-9, 0.07, 0.3, 1.0, 1.5, 1e9}) {
        expect_poisson_disk(points, poisson_disk_subset(points, spacing, 1, {}), spacing);
    }
}

TEST_P(PoissonDiskOn, IsAscendingAndWithoutRepeats) {
    const Indices chosen = poisson_disk_subset(points, 0.2, 5, {});
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
    EXPECT_EQ(std::set<std::uint32_t>(chosen.begin(), chosen.end()).size(), chosen.size());
    EXPECT_EQ(chosen.empty(), points.cols() == 0);
}

TEST_P(PoissonDiskOn, DoesNotDependOnTheNumberOfThreads) {
    const Indices one = poisson_disk_subset(points, 0.2, 9, {.threads = 1});
    EXPECT_EQ(poisson_disk_subset(points, 0.2, 9, {.threads = 2}), one);
    EXPECT_EQ(poisson_disk_subset(points, 0.2, 9, {.threads = 8}), one);
}

TEST_P(PoissonDiskOn, SpacingZeroChoosesEveryPoint) {
    const Indices chosen = poisson_disk_subset(points, 0.0, 1, {});
    ASSERT_EQ(chosen.size(), static_cast<std::size_t>(points.cols()));
    for (std::uint32_t i = 0; i < chosen.size(); ++i) ASSERT_EQ(chosen[i], i);
}

INSTANTIATE_TEST_SUITE_P(Clouds, PoissonDiskOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(PoissonDisk, AnotherSeedChoosesOtherPoints) {
    const Points points = test::random_box(2000, 1);
    const Indices first = poisson_disk_subset(points, 0.1, 1, {});
    EXPECT_NE(poisson_disk_subset(points, 0.1, 2, {}), first);
    EXPECT_EQ(poisson_disk_subset(points, 0.1, 1, {}), first);
}

TEST(PoissonDisk, HoldsAcrossTheCellsThatThreadsShare) {
    const Points points = test::random_box(6000, 2);
    const Indices one = poisson_disk_subset(points, 0.02, 3, {});
    expect_poisson_disk(points, one, 0.02);
    for (const int threads : {2, 5}) {
        EXPECT_EQ(poisson_disk_subset(points, 0.02, 3, {.threads = threads}), one);
    }
}

TEST(PoissonDisk, HoldsWhereAStrayPointIsFarAway) {
    Points points = test::random_box(500, 2);
    points.col(77) = Eigen::Vector3d(1e12, -1e12, 1e12);
    expect_poisson_disk(points, poisson_disk_subset(points, 0.2, 3, {}), 0.2);
}

TEST(PoissonDisk, OfIdenticalPointsKeepsOne) {
    EXPECT_EQ(poisson_disk_subset(Points::Ones(3, 1000), 1e-12, 1, {}).size(), 1U);
}

TEST(PoissonDisk, DoesNotPreferPointsByTheirOrder) {
    // In the order of the file, the first of each pair of neighbours would always win.
    Points points(3, 20000);
    points.setZero();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points(0, i) = 10.0 * static_cast<double>(i / 2) + static_cast<double>(i % 2);
    }
    const Indices chosen = poisson_disk_subset(points, 2.0, 3, {});
    ASSERT_EQ(chosen.size(), 10000U);
    const auto firsts =
        std::count_if(chosen.begin(), chosen.end(), [](auto i) { return i % 2 == 0; });
    EXPECT_NEAR(static_cast<double>(firsts), 5000, 250);
}

TEST(PoissonDisk, FillsADensePlaneAsDartThrowingDoes) {
    Points points = test::random_box(40000, 4);
    points.row(2).setZero();
    const double spacing = 0.05;
    const double density =
        static_cast<double>(poisson_disk_subset(points, spacing, 1, {}).size()) * spacing * spacing;
    EXPECT_GT(density, 0.66);  // random sequential packing of disks saturates near .70
    EXPECT_LT(density, 0.80);
}

TEST(PoissonDisk, IsTheSameAtMapCoordinates) {
    // Lattice coordinates are exact in double on both sides, so the choice must be, too.
    Points points = test::lattice(12);
    const Indices near = poisson_disk_subset(points, 1.7, 6, {});
    points.colwise() += Eigen::Vector3d(1e7, -3e7, 1e7);
    EXPECT_EQ(poisson_disk_subset(points, 1.7, 6, {}), near);
}

TEST(PoissonDisk, StopsWhenCancelled) {
    std::stop_source source;
    source.request_stop();
    const Execution execution{.stop = source.get_token()};
    EXPECT_THROW((void)poisson_disk_subset(test::random_box(10, 1), 0.1, 1, execution), Error);
}

TEST(PoissonDisk, ReportsProgressToTheEnd) {
    double last = 0;
    Execution execution;
    execution.progress = [&](const Progress& progress) { last = progress.fraction; };
    (void)poisson_disk_subset(test::random_box(100, 1), 0.1, 1, execution);
    EXPECT_EQ(last, 1);
}

/// A triangle of area 3, one of area 1, and one without area.
struct TriangleSampling : testing::Test {
    TriangleSampling() : vertices(3, 7), triangles(3, 3) {
        vertices << 0, 3, 0, 10, 11, 10, 20,  //
            0, 0, 2, 0, 0, 2, 0,              //
            1, 1, 1, 5, 5, 5, 0;
        triangles << 0, 3, 0,  //
            1, 4, 6,           //
            2, 5, 0;
    }
    Points vertices;
    Triangles triangles;
};

TEST_F(TriangleSampling, GivesEachTriangleItsShareOfTheArea) {
    const Points samples = sample_triangles(vertices, triangles, 1000, 1);
    const auto on_first = (samples.row(0).array() < 5).count();
    EXPECT_NEAR(static_cast<double>(samples.cols()), 4000, 1);
    EXPECT_NEAR(static_cast<double>(on_first), 3000, 1);
}

TEST_F(TriangleSampling, StaysOnTheTriangles) {
    const Points samples = sample_triangles(vertices, triangles, 500, 2);
    for (const auto& sample : samples.colwise()) {
        const bool first = sample.x() < 5;
        const double a = first ? sample.x() / 3 : sample.x() - 10;
        const double b = sample.y() / 2;
        ASSERT_GE(a, -1e-12);
        ASSERT_GE(b, -1e-12);
        ASSERT_LE(a + b, 1 + 1e-12);
        ASSERT_DOUBLE_EQ(sample.z(), first ? 1 : 5);
    }
}

TEST_F(TriangleSampling, IsUniformInsideATriangle) {
    const Points samples = sample_triangles(vertices, triangles.leftCols(1), 10000, 3);
    const Eigen::Vector3d mean = samples.rowwise().mean();
    EXPECT_NEAR((mean - Eigen::Vector3d(1, 2.0 / 3, 1)).norm(), 0, 0.02);
    // The quarter next to a corner holds a quarter of the points.
    const auto corner = ((samples.row(0) / 3 + samples.row(1) / 2).array() < 0.5).count();
    EXPECT_NEAR(static_cast<double>(corner) / static_cast<double>(samples.cols()), 0.25, 0.01);
}

TEST_F(TriangleSampling, GivesAMeshAtLeastOnePoint) {
    const Points samples = sample_triangles(vertices, triangles, 1e-9, 4);
    ASSERT_EQ(samples.cols(), 1);
    EXPECT_LT(samples(0, 0), 5) << "the largest triangle should have it";
}

TEST_F(TriangleSampling, GivesTrianglesWithoutAreaNothing) {
    EXPECT_EQ(sample_triangles(vertices, triangles.rightCols(1), 1e6, 5).cols(), 0);
    EXPECT_EQ(sample_triangles(vertices, Triangles(3, 0), 10, 5).cols(), 0);
}

TEST_F(TriangleSampling, DependsOnTheSeedAlone) {
    const Points first = sample_triangles(vertices, triangles, 100, 6);
    EXPECT_EQ(sample_triangles(vertices, triangles, 100, 6), first);
    EXPECT_NE(sample_triangles(vertices, triangles, 100, 7).leftCols(300), first.leftCols(300));
}

TEST(TriangleSamples, RoundsUpAndDownWithoutPreference) {
    Points corners(3, 3);
    corners << 0, 1, 0, 0, 0, 1, 0, 0, 0;
    Triangles triangle(3, 1);
    triangle << 0, 1, 2;
    double total = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const auto count = sample_triangles(corners, triangle, 5.0, seed).cols();  // 2.5 expected
        EXPECT_TRUE(count == 2 || count == 3);
        total += static_cast<double>(count);
    }
    EXPECT_NEAR(total / 400, 2.5, 0.1);
}

TEST(TriangleSamples, DrawsOtherPlacesInEveryTriangle) {
    Points corners(3, 6);
    corners << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,         //
        0, 0, 0, 5, 5, 5;
    Triangles triangles(3, 2);
    triangles << 0, 3, 1, 4, 2, 5;
    const Points samples = sample_triangles(corners, triangles, 40.0, 7);
    ASSERT_EQ(samples.cols(), 40);
    const Eigen::Vector2d low = samples.col(0).head<2>();
    const Eigen::Vector2d high = samples.col(20).head<2>();
    EXPECT_GT((low - high).norm(), 1e-9) << "the second triangle repeats the first";
}

TEST(PoissonDiskSubset, OfSomePlacesOfAGridChoosesAmongThemAlone) {
    const Points points = test::random_box(3000, 8);
    const PointGrid grid(points, 0.1);
    std::vector<std::uint32_t> places;
    for (std::uint32_t i = 0; i < grid.size(); i += 3) places.push_back(i);
    const Indices chosen = poisson_disk_subset(grid, places, 0.15, 4, {});
    Points some(3, static_cast<Eigen::Index>(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        some.col(static_cast<Eigen::Index>(i)) = grid.point(places[i]);
    }
    expect_poisson_disk(some, chosen, 0.15);
}

}  // namespace
}  // namespace lpf
