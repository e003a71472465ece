// Denoising against its definition: one outer iteration, voted on in doubles, point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "core/base/error.h"
#include "core/denoise.h"
#include "core/field_set.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

DenoiseParams params_for(bool sharp) {
    DenoiseParams params;
    params.analysis.radius = 0.35;
    params.analysis.probing = ProbingKind::NoiseAware;
    params.analysis.iterations = 1;
    params.analysis.atoms = 6;
    params.analysis.lambda = 0.05;
    params.iterations = 1;
    params.sharp = sharp;
    return params;
}

/// A thin plate and, far away, single points that no LPF says anything about.
Shape noisy_shape() {
    Shape shape;
    const Points plate = test::make_thin_plate({.points = 1500, .noise = 0.02}, 0.2).points;
    shape.cloud.points.resize(3, plate.cols() + 3);
    shape.cloud.points << plate, 9 * Eigen::Matrix3d::Identity();
    return shape;
}

/// Mean representation error over that of each LPF [input length], cubed for sharp edges.
std::vector<double> reliabilities(const AnalysisResult& analysis, bool sharp) {
    std::vector<double> errors;
    for (std::size_t j = 0; j < analysis.frames.size(); ++j) {
        errors.push_back(double{analysis.residuals[j]} * analysis.frames[j].radius /
                         analysis.radius);
    }
    const double mean =
        std::accumulate(errors.begin(), errors.end(), 0.0) / static_cast<double>(errors.size());
    for (double& error : errors) {
        error = std::pow((mean + 1e-4) / (error + 1e-4), sharp ? 3 : 1);
    }
    return errors;
}

/// The weighted means of what all LPFs propose for the points under their disks.
Points vote(const Shape& shape, const FieldSet& fields, const AnalysisResult& analysis,
            bool sharp) {
    const std::vector<double> trust = reliabilities(analysis, sharp);
    const Pattern& pattern = fields.pattern();
    const int stride = pattern.padded_size();
    Points moves = Points::Zero(3, shape.cloud.points.cols());
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(moves.cols());
    std::vector<float> field(3 * static_cast<std::size_t>(stride));
    for (std::size_t j = 0; j < fields.size(); ++j) {
        if (fields.dimensions[j] == kTooFewPoints) continue;
        analysis.dictionary.decode(analysis.codes[j], field);
        for (Eigen::Index i = 0; i < moves.cols(); ++i) {
            const Vector3f p = fields.frames[j].to_local(shape.cloud.points.col(i));
            const double squared = double{p.x()} * p.x() + double{p.y()} * p.y();
            const Vector3d at = (shape.cloud.points.col(i) - fields.frames[j].centre);
            if (squared >= 1 || at.norm() > 1.1 * fields.frames[j].radius) continue;
            const Pattern::Stencil stencil = pattern.stencil(p.x(), p.y());
            Vector3f target(p.x(), p.y(), 0);
            for (int k = 0; k < 4; ++k) {
                const float* node = field.data() + stencil.node[k];
                target += stencil.weight[k] * Vector3f(node[0], node[stride], node[2 * stride]);
            }
            const double weight =
                std::clamp(trust[j] * (sharp ? 1 : std::pow(1 - squared, 2)), 0x1p-20, 0x1p10);
            const Vector3d goal = fields.frames[j].to_world(target);
            moves.col(i) += weight * (goal - shape.cloud.points.col(i));
            weights[i] += weight;
        }
    }
    for (Eigen::Index i = 0; i < moves.cols(); ++i) {
        if (weights[i] > 0) moves.col(i) /= weights[i];
    }
    return moves;
}

class DenoiseVotes : public testing::TestWithParam<bool> {};

TEST_P(DenoiseVotes, AreTheWeightedMeansOfAllFields) {
    const Shape shape = noisy_shape();
    const DenoiseParams params = params_for(GetParam());
    FieldSet fields(shape, params.analysis, {});
    fields.optimise_poses(params.analysis.pose_iterations, {});
    const AnalysisResult analysis = analyze(fields, params.analysis, {});
    const Points expected = vote(shape, fields, analysis, params.sharp);

    const Points found = denoise(shape, params, {}).points - shape.cloud.points;
    ASSERT_GT(expected.colwise().norm().mean(), 0.005);
    // The disk's rim is cut in floats: a point on it may be in for one and out for the other.
    int apart = 0;
    for (Eigen::Index i = 0; i < expected.cols(); ++i) {
        apart += (found.col(i) - expected.col(i)).norm() > 1e-5;
    }
    EXPECT_LE(apart, 2);
    EXPECT_EQ(found.rightCols(3), Points::Zero(3, 3)) << "single points stay where they are";
}

INSTANTIATE_TEST_SUITE_P(Weights, DenoiseVotes, testing::Bool(),
                         [](const auto& test) { return test.param ? "Sharp" : "Smooth"; });

TEST(DenoiseLoop, StartsFromTheDictionaryOfTheIterationBefore) {
    Shape shape = noisy_shape();
    DenoiseParams params = params_for(false);
    params.iterations = 2;
    params.stop_ratio = 0;
    const Points together = denoise(shape, params, {}).points;

    params.iterations = 1;
    DenoiseResult first = denoise(shape, params, {});
    shape.cloud.points = first.points;
    params.analysis.initial_dictionary = first.analysis.dictionary;
    EXPECT_EQ(denoise(shape, params, {}).points, together);
}

TEST(DenoiseLoop, StopsAtTheShareOfTheFirstMove) {
    Shape shape;
    shape.cloud.points = test::make_plane({.points = 1000, .noise = 0.03}).points;
    DenoiseParams params = params_for(false);
    params.analysis.random_seed = 2;  // its moves shrink more than once
    params.iterations = 4;
    params.stop_ratio = 0;
    const std::vector<double> moves = denoise(shape, params, {}).rms_moves;
    ASSERT_EQ(moves.size(), 4U);
    ASSERT_LT(moves[2], 0.95 * moves[1]);
    params.stop_ratio = (moves[1] + moves[2]) / 2 / moves[0];
    EXPECT_EQ(denoise(shape, params, {}).rms_moves.size(), 3U);
}

TEST(DenoiseLoop, StopsAtOnceWhereNothingMoves) {
    Shape shape;
    shape.cloud.points = 10 * Points::Identity(3, 3);
    DenoiseParams params = params_for(false);
    params.iterations = 5;
    EXPECT_EQ(denoise(shape, params, {}).rms_moves, std::vector<double>{0.0});
}

TEST(DenoiseParameters, AreCheckedEachUnderItsName) {
    const Shape shape = noisy_shape();
    const auto field_of = [&](const std::function<void(DenoiseParams&)>& spoil) {
        DenoiseParams params = params_for(false);
        spoil(params);
        try {
            (void)denoise(shape, params, {});
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
            return error.field();
        }
        return std::string("accepted");
    };
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(field_of([](auto& p) { p.iterations = 0; }), "denoiseIterations");
    EXPECT_EQ(field_of([](auto& p) { p.iterations = 51; }), "denoiseIterations");
    EXPECT_EQ(field_of([](auto& p) { p.gamma = -0.1; }), "gamma");
    EXPECT_EQ(field_of([&](auto& p) { p.gamma = infinity; }), "gamma");
    EXPECT_EQ(field_of([](auto& p) { p.stop_ratio = -0.1; }), "stopRatio");
    EXPECT_EQ(field_of([](auto& p) { p.stop_ratio = 1.1; }), "stopRatio");
    EXPECT_EQ(field_of([](auto& p) { p.least_bent = -0.1; }), "leastBent");
    EXPECT_EQ(field_of([](auto& p) { p.least_bent = 1.1; }), "leastBent");
}

}  // namespace
}  // namespace lpf
