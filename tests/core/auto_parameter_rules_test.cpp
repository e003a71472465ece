// The rules of docs/parameters.md, on measurements made up for the purpose.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/auto_parameters.h"
#include "core/base/error.h"
#include "tests/support/meshes.h"

namespace lpf {
namespace {

Measurements measured(double noise) {
    return {.points = 5000,
            .diagonal = 20.0,
            .mean_spacing = 0.1,
            .noise = noise,
            .density_radius = 1.0};
}

const Shape kCloud;  // the rules look at the measurements, and at whether there are triangles

ResolvedParameters resolve(Task task, double noise, const ParameterRequest& request = {},
                           const Shape& shape = kCloud) {
    return resolve_parameters(task, shape, measured(noise), request);
}

TEST(AutoParameterRules, TheRadiusComesFromDensityAndNoise) {
    EXPECT_NEAR(resolve(Task::Denoise, 0).analysis.radius, 0.4, 1e-12);
    EXPECT_NEAR(resolve(Task::Denoise, 0.02).analysis.radius, std::hypot(0.48, 0.06), 1e-12);
    EXPECT_NEAR(resolve(Task::Denoise, 0.2).analysis.radius, std::hypot(0.6, 0.6), 1e-12);
    EXPECT_NEAR(resolve(Task::Analyze, 0.2, {}, test::cube_mesh()).analysis.radius, 0.5, 1e-12);
}

TEST(AutoParameterRules, LambdaGrowsWithTheNoiseInADisk) {
    const AnalysisParams noisy = resolve(Task::Denoise, 0.1).analysis;
    const double in_disk = 150 * noisy.radius * noisy.radius;
    EXPECT_NEAR(noisy.lambda, 3.5 * 0.1 / noisy.radius * std::sqrt(193 / in_disk), 1e-9);
    EXPECT_EQ(resolve(Task::Denoise, 0).analysis.lambda, 0.002);
    EXPECT_EQ(resolve(Task::Resample, 0.1, {}, test::cube_mesh()).analysis.lambda, 0.002);
}

TEST(AutoParameterRules, EachTaskHasItsIterations) {
    EXPECT_EQ(resolve(Task::Denoise, 0.1).analysis.iterations, 1);
    EXPECT_EQ(resolve(Task::Resample, 0.1).analysis.iterations, 2);
    EXPECT_EQ(resolve(Task::Analyze, 0.1).analysis.iterations, 10);
}

TEST(AutoParameterRules, ASecondOuterIterationIsForWhatIsNotFlat) {
    ParameterRequest request;
    request.radius = 1.0;
    for (const double noise : {0.001, 0.059, 0.061, 0.3}) {
        EXPECT_EQ(resolve(Task::Denoise, noise, request).denoise.iterations, 2);
        EXPECT_GT(resolve(Task::Denoise, noise, request).denoise.least_bent, 0.0);
        EXPECT_EQ(resolve(Task::Resample, noise, request).resample.denoise->iterations, 2);
    }
    request.denoise_iterations = 3;
    EXPECT_EQ(resolve(Task::Denoise, 0.1, request).denoise.iterations, 3);
    EXPECT_EQ(resolve(Task::Denoise, 0.1, request).denoise.least_bent, 0.0);
}

TEST(AutoParameterRules, ResamplingOfACloudDenoisesOnceAndEndsAtBorders) {
    const ResampleParams cloud = resolve(Task::Resample, 0.1).resample;
    ASSERT_TRUE(cloud.denoise.has_value());
    EXPECT_EQ(cloud.denoise->analysis.iterations, 1);
    EXPECT_EQ(cloud.denoise->analysis.radius, cloud.analysis.radius);
    EXPECT_NEAR(cloud.support, 1.5 * 0.1, 1e-12);
    Measurements clustered = measured(0.1);
    clustered.mean_spacing = 0.01;
    const ResolvedParameters resolved = resolve_parameters(Task::Resample, kCloud, clustered, {});
    EXPECT_NEAR(resolved.resample.support, 1.5 / 12, 1e-12);
}

TEST(AutoParameterRules, ResamplingOfAMeshFollowsItExactly) {
    const ResampleParams mesh = resolve(Task::Resample, 0.1, {}, test::cube_mesh()).resample;
    EXPECT_FALSE(mesh.denoise.has_value());
    EXPECT_EQ(mesh.support, 0);
    EXPECT_EQ(mesh.detail, 1);
    EXPECT_EQ(resolve(Task::Resample, 0.1).resample.detail, 0);
}

TEST(AutoParameterRules, RadiiAdaptWherePointsMoveAndTheRadiusIsAutomatic) {
    EXPECT_EQ(resolve(Task::Denoise, 0.1).analysis.noise, 0.1);
    EXPECT_TRUE(resolve(Task::Denoise, 0.1).analysis.adapt_radius);
    EXPECT_EQ(resolve(Task::Analyze, 0.1).analysis.noise, 0) << "the paper's LPFs";
    EXPECT_FALSE(resolve(Task::Analyze, 0.1).analysis.adapt_radius);
    EXPECT_EQ(resolve(Task::Resample, 0.1, {}, test::cube_mesh()).analysis.noise, 0);
    ParameterRequest request;
    request.radius = 1.0;
    EXPECT_EQ(resolve(Task::Denoise, 0.1, request).analysis.noise, 0.1);
    EXPECT_FALSE(resolve(Task::Denoise, 0.1, request).analysis.adapt_radius);
}

TEST(AutoParameterRules, TheSeedAndTheChoicesOfTheUserArePassedOn) {
    ParameterRequest request;
    request.random_seed = 77;
    request.keep_dictionary = true;
    request.dictionary = Dictionary(Pattern::grid(8), 5);
    const AnalysisParams params = resolve(Task::Analyze, 0.1, request).analysis;
    EXPECT_EQ(params.random_seed, 77U);
    EXPECT_TRUE(params.keep_dictionary);
    EXPECT_TRUE(params.debias);
    EXPECT_EQ(params.atoms, 5);
    EXPECT_EQ(params.pattern.points, Pattern::grid(8).size());
}

TEST(AutoParameterRules, ThePatternIsAGridOfAboutTheSizeAskedFor) {
    ParameterRequest request;
    request.pattern_points = 200;
    const ResolvedParameters resolved = resolve(Task::Analyze, 0.1, request);
    EXPECT_EQ(resolved.analysis.pattern.points, 193);
    const auto value = std::ranges::find(resolved.values, "patternPoints", &ResolvedValue::name);
    ASSERT_NE(value, resolved.values.end());
    EXPECT_FALSE(value->automatic);
    EXPECT_EQ(value->rule, "given by the user");
    const auto radius = std::ranges::find(resolved.values, "radius", &ResolvedValue::name);
    EXPECT_TRUE(radius->automatic);
    EXPECT_NE(radius->rule, "given by the user");
}

TEST(AutoParameterRules, AFactorLeavesThreePointsAtLeast) {
    ParameterRequest request;
    request.factor = 1e-9;
    EXPECT_EQ(resolve(Task::Resample, 0.1, request).resample.target_points, 3U);
    request.factor = 0.5;
    EXPECT_EQ(resolve(Task::Resample, 0.1, request).resample.target_points, 2500U);
}

TEST(AutoParameterRules, ValuesOutOfRangeAreRefused) {
    ParameterRequest request;
    request.atoms = 257;
    EXPECT_THROW((void)resolve(Task::Denoise, 0.1, request), Error);
    request = {};
    request.lambda = -1.0;
    EXPECT_THROW((void)resolve(Task::Denoise, 0.1, request), Error);
}

TEST(AutoParameterRules, WarningsBeginAtTwoSpacingsAndAQuarterOfTheDiagonal) {
    const auto warnings = [](double radius) {
        ParameterRequest request;
        request.radius = radius;
        return resolve(Task::Denoise, 0.1, request).warnings.size();
    };
    EXPECT_EQ(warnings(0.19), 1U);
    EXPECT_EQ(warnings(0.21), 0U);
    EXPECT_EQ(warnings(4.9), 0U);
    EXPECT_EQ(warnings(5.1), 1U);
}

}  // namespace
}  // namespace lpf
