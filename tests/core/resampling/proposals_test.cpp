#include "core/resampling/proposals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/resampling/count_sample.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

namespace lpf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

Candidates propose_all(const FieldSet& fields, const AnalysisResult& analysis,
                       const ResampleParams& params, double spacing) {
    std::vector<std::uint32_t> all(fields.size());
    std::iota(all.begin(), all.end(), 0U);
    return Proposer(fields, analysis, params, spacing)
        .propose(all, CellLattice{}.space_of(CellLattice::everything()), {});
}

/// LPFs of a curved sheet with a border and a few lonely points, analysed.
class ProposalsOf : public testing::Test {
protected:
    ProposalsOf() {
        const Points sheet = test::make_open_sheet({.points = 1200, .noise = 0.01}).points;
        const Points sparse = 0.25 * test::make_plane({.points = 11, .seed = 5}).points;
        shape.cloud.points.resize(3, sheet.cols() + 14);
        shape.cloud.points << sheet, sparse.colwise() + Vector3d(0, 0, 5),
            9 * Eigen::Matrix3d::Identity();
        params.analysis.radius = 0.35;
        params.analysis.iterations = 1;
        params.analysis.atoms = 6;
        params.analysis.lambda = 0.02;
        params.target_spacing = 1.0;
        fields = std::make_unique<FieldSet>(shape, params.analysis, Execution{});
        analysis = analyze(*fields, params.analysis, {});
    }

    [[nodiscard]] Candidates proposals(double spacing) const {
        return propose_all(*fields, analysis, params, spacing);
    }

    /// What LPF j proposes, in its own frame, in order.
    [[nodiscard]] std::vector<Vector3f> of_field(const Candidates& candidates,
                                                 std::size_t j) const {
        std::vector<Vector3f> result;
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            if (candidates.field[i] != j) continue;
            result.push_back(
                fields->frames[j].to_local(candidates.points.col(static_cast<Eigen::Index>(i))));
        }
        return result;
    }

    /// The nodes of LPF j, from the centre outwards, moved by its decoded field.
    [[nodiscard]] std::vector<Vector3f> moved_nodes(std::size_t j) const {
        const Pattern& pattern = fields->pattern();
        const auto stride = static_cast<std::size_t>(pattern.padded_size());
        std::vector<float> field(3 * stride);
        analysis.dictionary.decode(analysis.codes[j], field);
        std::vector<Vector3f> result;
        for (const int node : pattern.by_distance()) {
            const auto i = static_cast<std::size_t>(node);
            result.push_back(pattern.point(node) +
                             Vector3f(field[i], field[stride + i], field[2 * stride + i]));
        }
        return result;
    }

    [[nodiscard]] std::vector<std::size_t> supported(const Candidates& all, double spacing,
                                                     int& near_the_limit) const;

    Shape shape;
    ResampleParams params;
    std::unique_ptr<FieldSet> fields;
    AnalysisResult analysis{Dictionary(Pattern::grid(4), 1), {}, {}, {}, {}, {}, {}, 0.0, 0.0};
};

TEST_F(ProposalsOf, AreTheMovedNodesFromTheCentreOutwards) {
    const Candidates candidates = proposals(1.0);
    EXPECT_TRUE(std::ranges::is_sorted(candidates.field));
    for (std::size_t j = 0; j < fields->size(); ++j) {
        if (fields->dimensions[j] == kTooFewPoints) continue;
        const std::vector<Vector3f> found = of_field(candidates, j);
        const std::vector<Vector3f> expected = moved_nodes(j);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            ASSERT_LT((found[i] - expected[i]).norm(), 1e-4F);
        }
    }
}

TEST_F(ProposalsOf, AreTheLonelyPointsThemselves) {
    const Candidates candidates = proposals(1.0);
    for (const Vector3d& lonely : shape.cloud.points.rightCols(3).colwise()) {
        bool proposed = false;
        for (const Vector3d& point : candidates.points.colwise()) {
            proposed |= (point - lonely).norm() < 1e-6;
        }
        EXPECT_TRUE(proposed) << lonely.transpose();
    }
}

TEST_F(ProposalsOf, ASampleForetellsTheirConsensusHoweverManyPointsAreWanted) {
    const double spacing = 0.05;
    const Proposer proposer(*fields, analysis, params, spacing);
    const auto all = static_cast<double>(
        find_consensus(propose_all(*fields, analysis, params, spacing), spacing, {}).size());
    for (const double wanted : {1e3, 1e6, 1e9}) {
        const CountSample sample(*fields, proposer, spacing, wanted, {});
        const double foretold = sample.count(spacing, {});
        EXPECT_GT(foretold, 0.5 * all) << wanted;
        EXPECT_LT(foretold, 2.0 * all) << wanted;
    }
}

TEST_F(ProposalsOf, LieCloserThanTheSpacingWhereTheNodesDoNot) {
    const double spacing = 0.015;  // a third of the pattern's step
    const Candidates candidates = proposals(spacing);
    int checked = 0;
    int to_the_rim = 0;
    for (std::size_t j = 0; j < fields->size(); j += 11) {
        if (fields->dimensions[j] == kTooFewPoints) continue;
        const std::vector<Vector3f> found = of_field(candidates, j);
        const double apart = spacing / params.analysis.radius;
        const double expected = std::numbers::pi / (0.9 * 0.9 * apart * apart);
        EXPECT_GT(static_cast<double>(found.size()), 0.97 * expected);
        EXPECT_LT(static_cast<double>(found.size()), 2.5 * expected);
        EXPECT_LT(found.front().head<2>().norm(), 0.15F) << "not the centre first";
        // Nodes beyond the border of the sheet are pulled to it.
        checked += 1;
        to_the_rim += found.back().head<2>().norm() > 0.85F;
    }
    EXPECT_GT(2 * to_the_rim, checked);
}

/// How many places of each LPF have a target point as near as the shape is known to go on, and
/// either one that is very near or others that do not all lie to one side.
std::vector<std::size_t> ProposalsOf::supported(const Candidates& all, double spacing,
                                                int& near_the_limit) const {
    std::vector<std::size_t> expected(fields->size(), 0);
    fields->for_each_target("", {}, [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
        const TargetArea& target = worker.probe.target;
        if (fields->dimensions[j] == kTooFewPoints) {
            expected[j] = target.size;
            return;
        }
        const double local =
            std::min(0.5, 1.2 * std::sqrt(std::numbers::pi / static_cast<double>(target.size)));
        const double limit = std::max({params.support / 0.35, spacing / 2 / 0.35, local});
        for (const Vector3f& place : of_field(all, j)) {
            double least = 1e30;
            double around = 0;
            Vector2d directions = Vector2d::Zero();
            for (std::size_t i = 0; i < target.size; ++i) {
                const Vector2d p(double{target.x[i]}, double{target.y[i]});
                const Vector2d offset = p - place.head<2>().cast<double>();
                least = std::min(least, offset.norm());
                if (offset.norm() > 2 * limit) continue;
                around += 1;
                directions += offset / std::max(offset.norm(), 1e-6);
            }
            const double one_sided = around > 0 ? directions.norm() / around : 1.0;
            near_the_limit += std::abs(least - limit) < 1e-4 ||
                              std::abs(least - limit / 4) < 1e-4 ||
                              std::abs(one_sided - 0.7) < 1e-2;
            expected[j] += least <= limit && (least <= limit / 4 || one_sided < 0.7);
        }
    });
    return expected;
}

TEST_F(ProposalsOf, EndWhereNoPointSupportsThem) {
    for (const auto& [support, spacing] :
         {std::pair(0.06, 0.1), std::pair(0.14, 0.1), std::pair(0.06, 0.3)}) {
        params.support = 0;
        const Candidates all = proposals(spacing);
        params.support = support;
        const Candidates found = proposals(spacing);
        EXPECT_LT(found.size(), all.size());
        int near_the_limit = 0;
        const std::vector<std::size_t> expected = supported(all, spacing, near_the_limit);
        int apart = 0;
        for (std::size_t j = 0; j < fields->size(); ++j) {
            const auto count = std::ranges::count(found.field, static_cast<std::uint32_t>(j));
            apart += std::abs(static_cast<int>(count) - static_cast<int>(expected[j]));
        }
        EXPECT_LE(apart, near_the_limit) << "support " << support << ", spacing " << spacing;
    }
}

TEST_F(ProposalsOf, PutBackTheDetailAskedFor) {
    const Candidates consolidated = proposals(1.0);
    params.detail = 1.0;
    const Candidates exact = proposals(1.0);
    params.detail = 0.25;
    const Candidates quarter = proposals(1.0);
    const auto stride = static_cast<std::size_t>(fields->pattern().padded_size());
    fields->for_each_probed("", {}, [&](std::size_t j, auto& worker, std::size_t) {
        const std::vector<Vector3f> smooth = of_field(consolidated, j);
        const std::vector<Vector3f> full = of_field(exact, j);
        const std::vector<Vector3f> part = of_field(quarter, j);
        if (full.size() != smooth.size() || part.size() != smooth.size()) return;  // a jump
        for (std::size_t k = 0; k < full.size(); ++k) {
            const int node = fields->pattern().by_distance()[k];
            const auto i = static_cast<std::size_t>(node);
            const Vector3f probed =
                fields->pattern().point(node) +
                Vector3f(worker.field[i], worker.field[stride + i], worker.field[2 * stride + i]);
            ASSERT_LT((full[k] - probed).norm(), 1e-4F);
            ASSERT_LT((part[k] - smooth[k] - 0.25F * (probed - smooth[k])).norm(), 1e-4F);
        }
    });
}

TEST(ResampleSources, AreTheNearestPointsOfTheInputAsItWas) {
    Shape shape;
    shape.cloud.points = test::make_plane({.points = 800, .noise = 0.06}).points;
    ResampleParams params;
    params.analysis.radius = 0.4;
    params.analysis.iterations = 1;
    params.analysis.atoms = 4;
    params.analysis.probing = ProbingKind::NoiseAware;
    params.target_spacing = 0.1;
    params.denoise = DenoiseParams{.analysis = params.analysis, .iterations = 1};
    const ResampleResult result = resample(shape, params, {});
    for (Eigen::Index i = 0; i < result.points.cols(); ++i) {
        const auto distances = (shape.cloud.points.colwise() - result.points.col(i)).colwise();
        const auto source = static_cast<Eigen::Index>(result.source[static_cast<std::size_t>(i)]);
        ASSERT_NEAR(distances.norm().minCoeff(),
                    (shape.cloud.points.col(source) - result.points.col(i)).norm(), 1e-12);
    }
}

TEST(Proposals, OfAPieceThatBendsAwayFromItsPointsStayNearThem) {
    Shape plane;
    plane.cloud.points = test::make_plane({.points = 2000}).points;
    ResampleParams params;
    params.analysis.radius = 0.35;
    params.analysis.iterations = 1;
    params.analysis.atoms = 1;
    params.target_spacing = 0.05;
    params.support = 0.1;
    FieldSet fields(plane, params.analysis, {});
    const AnalysisResult analysis = analyze(fields, params.analysis, {});
    Piece bent;
    bent.dimension = kSurface;
    bent.coefficients[3] = 4.0F;  // at the rim of the disk four radii above the plane
    bent.reach = 10.0F;
    fields.pieces.assign(fields.size(), bent);
    const Candidates all = propose_all(fields, analysis, params, params.target_spacing);
    ASSERT_GT(all.size(), fields.size());
    EXPECT_LT(all.points.row(2).cwiseAbs().maxCoeff(), 2 * params.support);
}

TEST(Proposals, OfATubeLieAllAroundIt) {
    const double noise = 0.02;
    const double thickness = 2 * noise;
    const test::PiecePtr rod =
        test::union_surface({test::capsule({-1, 0, 0}, {1, 0, 0}, thickness)});
    const auto scan = test::sampled({"rod", {rod}}, {.points = 3000, .noise = noise, .seed = 3});
    const Shape shape{{scan.points, {}}, {}};
    ResampleParams params;
    params.analysis.radius = 0.25;
    params.analysis.noise = noise;
    params.analysis.probing = ProbingKind::NoiseAware;
    params.analysis.iterations = 1;
    params.analysis.atoms = 4;
    params.target_spacing = 0.02;
    params.support = 0.05;
    FieldSet fields(shape, params.analysis, {});
    fields.optimise_poses(params.analysis.pose_iterations, {});
    const AnalysisResult analysis = analyze(fields, params.analysis, {});
    const Candidates all = propose_all(fields, analysis, params, params.target_spacing);
    EXPECT_LT(test::error_to_shape(all.points, scan).rmse, 0.4 * noise);
    EXPECT_LT(test::coverage_of_shape(scan, all.points, 2000).surface, params.target_spacing);
}

}  // namespace
}  // namespace lpf
