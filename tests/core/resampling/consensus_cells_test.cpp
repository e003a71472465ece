#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "core/resampling/blocks.h"
#include "core/resampling/consensus.h"
#include "core/resampling/nearest_sources.h"
#include "tests/core/clouds.h"
#include "tests/support/metrics.h"

namespace lpf {
namespace {

using Eigen::Vector3d;

/// Like those of many LPFs: about twenty for each point of the consensus, on a wavy sheet of
/// `side` tau_p along x and y.
Candidates on_a_sheet(double side) {
    const auto n = static_cast<Eigen::Index>(20 * side * side);
    Candidates candidates{Points(3, n), {}};
    Random random(7);
    for (Eigen::Index i = 0; i < n; ++i) {
        // In patches, as LPFs follow each other.
        const double patch =
            std::floor(static_cast<double>(i) / 100) / static_cast<double>(n / 100);
        const double x = patch * side + random.uniform(-5, 5);
        const double y = random.uniform(0, side);
        candidates.points.col(i) = Vector3d(x, y, 9 * std::sin(0.1 * x + 0.05 * y));
        candidates.field.push_back(static_cast<std::uint32_t>(i / 100));
    }
    return candidates;
}

/// Whether a point lies within two tau_p of a border of cells.
bool is_near_border(const Vector3d& point, const CellLattice& cells) {
    const Eigen::Array3d at = (point - cells.corner).array() / cells.side;
    return cells.side * (at - at.round()).abs().minCoeff() < 2;
}

/// Mean and standard deviation.
Eigen::Vector2d moments(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return {mean, std::sqrt(squares / n)};
}

class ConsensusOfCells : public testing::Test {
protected:
    ConsensusOfCells() : consensus(candidates.points.col(0), 1.0) {
        consensus.settle(candidates, CellLattice::everything(), {.threads = 2});
        points = consensus.take().points;
    }

    const Candidates candidates = on_a_sheet(120);
    Consensus consensus;
    Points points;
};

TEST_F(ConsensusOfCells, LeavesNoTwoPointsNearerThanTheSpacing) {
    EXPECT_GT(points.cols(), 9000);
    EXPECT_GE(test::nearest_neighbour_stats(points).min, 1 - 1e-9);
}

TEST_F(ConsensusOfCells, IsAsDenseAndEvenAtBordersAsInside) {
    const std::vector<double> distances = test::nearest_neighbour_stats(points).distances;
    std::vector<double> of_border;
    std::vector<double> inside;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const Vector3d point = points.col(static_cast<Eigen::Index>(i));
        (is_near_border(point, consensus.cells()) ? of_border : inside).push_back(distances[i]);
    }
    ASSERT_GT(of_border.size(), 2000U);
    ASSERT_GT(inside.size(), 2000U);
    EXPECT_NEAR(moments(of_border)[0] / moments(inside)[0], 1, 0.01);
    EXPECT_LT(moments(of_border)[1], 1.1 * moments(inside)[1]);
}

TEST_F(ConsensusOfCells, LeavesNoGapsAtBorders) {
    const test::CloudDistance distance(points);
    std::vector<double> of_border;
    std::vector<double> inside;
    for (const Vector3d& candidate : candidates.points.colwise()) {
        const double off = distance(candidate);
        ASSERT_LE(off, 1 + 1e-6);
        (is_near_border(candidate, consensus.cells()) ? of_border : inside).push_back(off);
    }
    EXPECT_NEAR(moments(of_border)[0] / moments(inside)[0], 1, 0.02);
    EXPECT_NEAR(moments(of_border)[1] / moments(inside)[1], 1, 0.05);
}

TEST_F(ConsensusOfCells, DoesNotDependOnTheNumberOfThreads) {
    for (const int threads : {1, 5}) {
        Consensus other(candidates.points.col(0), 1.0);
        other.settle(candidates, CellLattice::everything(), {.threads = threads});
        EXPECT_EQ(other.take().points, points);
    }
}

TEST_F(ConsensusOfCells, BlockAfterBlockKeepsSpacingAndCoversEveryCandidate) {
    const Cell middle = consensus.cells().cell_of(Vector3d(60, 60, 0));
    CellBox low = CellLattice::everything();
    CellBox high = low;
    low.high.x() = high.low.x() = middle.x();
    Consensus parts(candidates.points.col(0), 1.0);
    for (const CellBox& box : {low, high}) {
        const Eigen::AlignedBox3d space = widened(parts.cells().space_of(box), 1.0);
        Candidates part{candidates.points, {}};
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            const Vector3d point = candidates.points.col(static_cast<Eigen::Index>(i));
            if (!space.contains(point)) continue;
            part.points.col(static_cast<Eigen::Index>(part.size())) = point;
            part.field.push_back(candidates.field[i]);
        }
        part.points.conservativeResize(3, static_cast<Eigen::Index>(part.size()));
        parts.settle(part, box, {.threads = 2});
    }
    const Points found = parts.take().points;
    EXPECT_NEAR(static_cast<double>(found.cols()) / static_cast<double>(points.cols()), 1, 0.01);
    EXPECT_GE(test::nearest_neighbour_stats(found).min, 1 - 1e-9);
    const test::CloudDistance distance(found);
    for (const Vector3d& candidate : candidates.points.colwise()) {
        ASSERT_LE(distance(candidate), 1 + 1e-6);
    }
}

std::vector<Frame> frames_at(const Points& centres, double radius) {
    std::vector<Frame> frames;
    for (const Vector3d& centre : centres.colwise()) frames.push_back({centre, radius});
    return frames;
}

TEST(Blocks, HoldAllLpfsNearThemAndDivideSpace) {
    Points centres = test::random_box(5000, 3, 0.0, 100.0);
    centres.row(2) *= 0.1;
    centres.col(17) = Vector3d(1e30, -1e9, 5);
    const std::vector<Frame> frames = frames_at(centres, 2.0);
    const CellLattice cells{Vector3d(1, 2, 3), 5.0};
    const std::vector<Block> blocks = divide(frames, cells, 0.5, 400);
    EXPECT_GT(blocks.size(), 12U);
    std::size_t total = 0;
    std::vector<int> homes(frames.size(), 0);
    for (const Block& block : blocks) {
        EXPECT_LE(block.fields.size(), 400U);
        EXPECT_TRUE(std::ranges::is_sorted(block.fields));
        total += block.fields.size();
        const Eigen::AlignedBox3d space = cells.space_of(block.box);
        std::vector<std::uint32_t> near;
        for (std::uint32_t j = 0; j < frames.size(); ++j) {
            if (space.exteriorDistance(centres.col(j)) <= 0.5 + kProposalReach * 2.0)
                near.push_back(j);
            homes[j] += block.box.holds(cells.cell_of(centres.col(j)));
        }
        for (const std::uint32_t j : near)
            EXPECT_TRUE(std::ranges::binary_search(block.fields, j)) << j;
    }
    for (const int count : homes) EXPECT_EQ(count, 1);
    EXPECT_LT(total, 2 * frames.size());
}

TEST(Blocks, OfLpfsAtOnePlaceAreOne) {
    const Points centres = Points::Constant(3, 1000, 7.0);
    EXPECT_EQ(divide(frames_at(centres, 1.0), CellLattice{}, 0.1, 10).size(), 1U);
}

class NearestSourcesOf : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(NearestSourcesOf, AgreeWithBruteForce) {
    const Points& cloud = GetParam().points;
    if (cloud.cols() == 0) GTEST_SKIP() << "No point is the nearest of none.";
    const Vector3d low = cloud.rowwise().minCoeff();
    const double extent = std::max((cloud.rowwise().maxCoeff() - low).maxCoeff(), 1e-3);
    // Among the points, around them, and far off.
    Points queries = test::random_box(60, 4, -0.5, 1.5) * extent;
    queries.rightCols(3) *= 1000;
    queries.colwise() += low;
    queries.leftCols(std::min<Eigen::Index>(10, cloud.cols())) =
        cloud.leftCols(std::min<Eigen::Index>(10, cloud.cols()));
    const std::vector<std::uint32_t> found = nearest_sources(cloud, queries, {.threads = 2});
    for (Eigen::Index i = 0; i < queries.cols(); ++i) {
        const auto source = static_cast<Eigen::Index>(found[static_cast<std::size_t>(i)]);
        const double least = (cloud.colwise() - queries.col(i)).colwise().norm().minCoeff();
        EXPECT_NEAR((cloud.col(source) - queries.col(i)).norm(), least,
                    1e-9 * (extent + cloud.cwiseAbs().maxCoeff()));
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, NearestSourcesOf, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

}  // namespace
}  // namespace lpf
