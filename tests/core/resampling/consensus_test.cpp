#include "core/resampling/consensus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stop_token>

#include "core/base/error.h"
#include "core/base/random.h"
#include "tests/core/clouds.h"

namespace lpf {
namespace {

using Eigen::Vector3d;

Candidates candidates_at(const Eigen::Matrix3Xd& points) {
    Candidates candidates{points, {}};
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        candidates.field.push_back(static_cast<std::uint32_t>(100 + i));
    }
    return candidates;
}

Vector3d position(const Candidates& candidates, std::size_t i) {
    return candidates.points.col(static_cast<Eigen::Index>(i));
}

/// The same candidates in the order in which their cells come: by colour.
Candidates by_colour(const Candidates& candidates, double spacing) {
    if (candidates.size() == 0) return candidates;
    const Consensus consensus(position(candidates, candidates.size() / 2), spacing);
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::size_t i) {
        const Cell cell = consensus.cells().cell_of(position(candidates, i));
        return (cell.x() & 1) + 2 * (cell.y() & 1) + 4 * (cell.z() & 1);
    });
    Candidates result{candidates.points, candidates.field};
    for (std::size_t i = 0; i < order.size(); ++i) {
        result.points.col(static_cast<Eigen::Index>(i)) = position(candidates, order[i]);
        result.field[i] = candidates.field[order[i]];
    }
    return result;
}

/// Points by the LPFs that proposed them first, which are of one point each here.
std::map<std::uint32_t, Vector3d> by_field(const Candidates& points) {
    std::map<std::uint32_t, Vector3d> result;
    for (std::size_t i = 0; i < points.size(); ++i) result[points.field[i]] = position(points, i);
    return result;
}

/// The definition, word by word, without a grid.
Candidates brute_force(const Candidates& candidates, double spacing) {
    std::vector<Vector3d> points;
    Candidates result;
    const auto near = [&](const Vector3d& a, const Vector3d& b) {
        return (a - b).norm() < spacing;
    };
    std::vector<bool> spent(candidates.size(), false);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (spent[i]) continue;
        Vector3d sum = Vector3d::Zero();
        double count = 0;
        const Vector3d proposed = position(candidates, i);
        for (std::size_t k = 0; k < candidates.size(); ++k) {
            if (near(position(candidates, k), proposed)) sum += position(candidates, k), ++count;
        }
        Vector3d point = sum / count;
        for (const Vector3d& taken : points) {
            if (near(taken, point)) point = proposed;
        }
        points.push_back(point);
        result.field.push_back(candidates.field[i]);
        for (std::size_t k = 0; k < candidates.size(); ++k) {
            if (near(position(candidates, k), point)) spent[k] = true;
        }
        spent[i] = true;
    }
    if (points.empty()) return result;
    result.points = Eigen::Map<const Points>(points.front().data(), 3,
                                             static_cast<Eigen::Index>(points.size()));
    return result;
}

class ConsensusOf : public testing::TestWithParam<test::NamedCloud> {
protected:
    const Candidates candidates = candidates_at(GetParam().points);
};

TEST_P(ConsensusOf, AgreesWithBruteForce) {
    for (const double spacing : {0.013, 0.171, 0.77, 3.1}) {
        const Candidates found = find_consensus(candidates, spacing, {});
        const Candidates expected = brute_force(by_colour(candidates, spacing), spacing);
        ASSERT_EQ(found.size(), expected.size()) << "spacing " << spacing;
        const auto places = by_field(found);
        for (const auto& [field, place] : by_field(expected)) {
            // Means are taken over float32 offsets in units of the spacing.
            ASSERT_LT((places.at(field) - place).norm(), 1e-6 * spacing);
        }
    }
}

TEST_P(ConsensusOf, KeepsTheSpacingAndCoversEveryCandidate) {
    const double spacing = 0.3;
    const Candidates found = find_consensus(candidates, spacing, {});
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE((position(found, i) - position(found, j)).norm(), spacing * (1 - 1e-9));
        }
    }
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const double nearest =
            (found.points.colwise() - position(candidates, k)).colwise().norm().minCoeff();
        // A candidate whose point moved off to a mean lies within a spacing of that mean.
        ASSERT_LE(nearest, spacing * (1 + 1e-6));
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, ConsensusOf, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Consensus, IsTheMeanOfAHeap) {
    const Points heap = test::random_box(40, 1, 0.0, 0.1);
    const Candidates found = find_consensus(candidates_at(heap), 1.0, {});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_LT((position(found, 0) - heap.rowwise().mean()).norm(), 1e-7);
    EXPECT_EQ(found.field[0], 100U) << "the first to propose it";
}

TEST(Consensus, StopsWhenCancelled) {
    std::stop_source source;
    source.request_stop();
    const Execution execution{.stop = source.get_token()};
    EXPECT_THROW((void)find_consensus(candidates_at(test::random_box(9, 1)), 0.1, execution),
                 Error);
}

}  // namespace
}  // namespace lpf
