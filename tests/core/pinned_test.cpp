// Values that are pinned: rules of the automatic parameters as formulas, and the quality reached on
// known shapes, so that no line of the method can change what comes out unnoticed. The numbers were
// measured with the program itself; a change that betters them moves them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/auto_parameters.h"
#include "core/base/error.h"
#include "tests/support/meshes.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

const Execution kExecution{.threads = 2};

Measurements measured(double noise) {
    return {.points = 10000,
            .diagonal = 10.0,
            .mean_spacing = 0.05,
            .noise = noise,
            .density_radius = 0.5};
}

double value_of(const ResolvedParameters& resolved, const std::string& name) {
    for (const ResolvedValue& value : resolved.values) {
        if (value.name == name) return value.value;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

TEST(PinnedRules, OfDenoisingACloud) {
    const double noise = 0.02;
    const auto resolved = resolve_parameters(Task::Denoise, {}, measured(noise), {});
    const double share = 0.4 + 0.2 * (2 * noise / 0.05);
    const double radius = std::hypot(share * 0.5, 3 * noise);
    EXPECT_NEAR(resolved.analysis.radius, radius, 1e-12);
    const double in_disk = 150 * std::pow(radius / 0.5, 2);
    EXPECT_NEAR(resolved.analysis.lambda, 3.5 * noise / radius * std::sqrt(193 / in_disk), 1e-12);
    EXPECT_EQ(resolved.analysis.noise, noise);
    EXPECT_TRUE(resolved.analysis.adapt_radius);
    EXPECT_TRUE(resolved.analysis.debias);
    EXPECT_EQ(value_of(resolved, "analysisIterations"), 1);
    EXPECT_EQ(value_of(resolved, "denoiseIterations"), 2);
    EXPECT_EQ(resolved.denoise.least_bent, 0.12);
    EXPECT_EQ(value_of(resolved, "atoms"), 16);
    EXPECT_EQ(resolved.analysis.probing, ProbingKind::NoiseAware);
}

TEST(PinnedRules, OfVeryNoisyAndOfQuietClouds) {
    const auto noisy = resolve_parameters(Task::Denoise, {}, measured(0.3), {});
    EXPECT_NEAR(noisy.analysis.radius, std::hypot(0.3, 0.9), 1e-12);
    EXPECT_EQ(noisy.denoise.iterations, 2);
    const auto quiet = resolve_parameters(Task::Denoise, {}, measured(0.0001), {});
    EXPECT_EQ(quiet.denoise.iterations, 2);
    EXPECT_EQ(resolve_parameters(Task::Denoise, {}, measured(0.0), {}).analysis.lambda, 0.002);
}

TEST(PinnedRules, OfResamplingAndOfAnalysis) {
    const auto cloud = resolve_parameters(Task::Resample, {}, measured(0.02), {});
    EXPECT_EQ(cloud.analysis.iterations, 2);
    EXPECT_NEAR(cloud.resample.support, 1.5 * 0.05, 1e-12);
    EXPECT_EQ(cloud.resample.detail, 0.0);
    ASSERT_TRUE(cloud.resample.denoise);
    EXPECT_EQ(cloud.resample.denoise->iterations, 2);
    EXPECT_EQ(cloud.resample.denoise->least_bent, 0.12);
    EXPECT_EQ(cloud.resample.denoise->analysis.noise, 0.02);
    EXPECT_NEAR(cloud.resample.analysis.noise, 0.25 * 0.02, 1e-12);
    EXPECT_EQ(cloud.resample.denoise->analysis.iterations, 1);
    EXPECT_EQ(cloud.resample.target_points, 10000U);
    EXPECT_EQ(resolve_parameters(Task::Analyze, {}, measured(0.02), {}).analysis.iterations, 10);
    ParameterRequest request;
    request.factor = 0.0001;
    EXPECT_EQ(
        resolve_parameters(Task::Resample, {}, measured(0.02), request).resample.target_points, 3U);
    request.factor = 2.5;
    EXPECT_EQ(
        resolve_parameters(Task::Resample, {}, measured(0.02), request).resample.target_points,
        25000U);
}

TEST(PinnedRules, OfAMesh) {
    const auto mesh = resolve_parameters(Task::Resample, test::cube_mesh(), measured(0.02), {});
    EXPECT_EQ(mesh.analysis.radius, 0.25);
    EXPECT_EQ(mesh.analysis.lambda, 0.002);
    EXPECT_EQ(mesh.analysis.pattern.points, 793);
    EXPECT_EQ(mesh.analysis.noise, 0.0);
    EXPECT_EQ(mesh.resample.detail, 1.0);
    EXPECT_EQ(mesh.resample.support, 0.0);
    EXPECT_FALSE(mesh.resample.denoise);
}

TEST(PinnedRules, WhatTheUserGives) {
    ParameterRequest request;
    request.radius = 0.2;
    request.pattern_points = 200;
    auto resolved = resolve_parameters(Task::Denoise, {}, measured(0.02), request);
    EXPECT_FALSE(resolved.analysis.adapt_radius) << "a radius that is given holds everywhere";
    EXPECT_EQ(resolved.analysis.pattern.points, 193) << "the nearest grid";
    EXPECT_EQ(resolved.values.front().rule, "given by the user");
    EXPECT_TRUE(resolved.warnings.empty());
    for (const double radius : {0.09, 2.6}) {
        request.radius = radius;
        EXPECT_EQ(resolve_parameters(Task::Denoise, {}, measured(0.02), request).warnings.size(),
                  1U);
    }
    request.radius = -1.0;
    EXPECT_THROW((void)resolve_parameters(Task::Denoise, {}, measured(0.02), request), Error);
}

TEST(PinnedDenoise, RefusesWhatIsOutOfRange) {
    Shape shape{{test::make_sphere({.points = 300}).points, {}}, {}};
    const DenoiseParams good{.analysis = {.radius = 0.3}};
    const auto refused = [&](DenoiseParams params) {
        EXPECT_THROW((void)denoise(shape, params, {}), Error);
    };
    DenoiseParams params = good;
    params.iterations = 51;
    refused(params);
    params = good;
    params.gamma = std::numeric_limits<double>::infinity();
    refused(params);
    params = good;
    params.stop_ratio = -0.1;
    refused(params);
    shape.triangles = Triangles(3, 1);
    shape.triangles << 0, 1, 2;
    params = good;
    params.analysis.probing = ProbingKind::NearestTriangle;
    refused(params);
}

/// Means of some draws of seeds: one alone is up to a third off.
struct Quality {
    const char* shape;
    std::size_t points;
    double noise;
    double rmse;    // of the denoised points to the exact shape
    double energy;  // of the first analysis, after learning
    double fields;  // of the first, too
};

constexpr std::uint64_t kDraws = 8;

class PinnedQuality : public testing::TestWithParam<Quality> {};

TEST_P(PinnedQuality, OfDenoisingWithAutomaticParameters) {
    const Quality& pinned = GetParam();
    const auto scan =
        test::make_shape(pinned.shape, {.points = pinned.points, .noise = pinned.noise, .seed = 4});
    const Shape shape{{scan.points, {}}, {}};
    DenoiseParams params =
        resolve_parameters(Task::Denoise, shape, measure(scan.points, kExecution), {}).denoise;
    double rmse = 0;
    double energy = 0;
    double fields = 0;
    for (std::uint64_t draw = 1; draw <= kDraws; ++draw) {
        params.analysis.random_seed = draw;
        rmse += test::error_to_shape(denoise(shape, params, kExecution).points, scan).rmse / kDraws;
        // Whether a second iteration follows may tip over, too.
        DenoiseParams once = params;
        once.iterations = 1;
        const AnalysisResult analysis = denoise(shape, once, kExecution).analysis;
        energy += analysis.energy.back().learning / kDraws;
        fields += static_cast<double>(analysis.frames.size()) / kDraws;
    }
    // Instruction sets round differently, and a choice of pieces may tip over: a little room.
    EXPECT_NEAR(rmse, pinned.rmse, 0.03 * pinned.rmse);
    EXPECT_NEAR(energy, pinned.energy, 0.03 * pinned.energy);
    EXPECT_NEAR(fields, pinned.fields, 0.03 * pinned.fields);
}

INSTANTIATE_TEST_SUITE_P(Shapes, PinnedQuality,
                         testing::Values(Quality{"cube", 12000, 0.02, 0.003634, 2.451, 755},
                                         Quality{"curve_on_surface", 12000, 0.02, 0.002014, 1.472,
                                                 250},
                                         Quality{"thin_plate", 12000, 0.008, 0.000947, 0.5518, 405},
                                         Quality{"open_sheet", 8000, 0.05, 0.006013, 1.211, 184}),
                         [](const auto& each) { return std::string(each.param.shape); });

}  // namespace
}  // namespace lpf
