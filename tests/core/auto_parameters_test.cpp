#include "core/auto_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "tests/support/meshes.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

Shape shape_named(const std::string& name, std::size_t points, double noise) {
    Shape shape;
    shape.cloud.points = test::make_shape(name, {.points = points, .noise = noise}).points;
    return shape;
}

ResolvedParameters resolve(Task task, const Shape& shape, const ParameterRequest& request = {}) {
    return resolve_parameters(task, shape, measure(shape.cloud.points, {}), request);
}

const ResolvedValue& value_named(const ResolvedParameters& resolved, const std::string& name) {
    const auto found = std::ranges::find(resolved.values, name, &ResolvedValue::name);
    if (found == resolved.values.end()) throw std::out_of_range(name);
    return *found;
}

class AutoParametersFor : public testing::TestWithParam<Task> {
protected:
    const Task task = GetParam();
};

TEST_P(AutoParametersFor, AreValidForCloudsAndMeshes) {
    for (const Shape& shape : {shape_named("sphere", 2000, 0.0), shape_named("cube", 2000, 0.03),
                               shape_named("helix", 500, 0.01), shape_named("plane", 20, 0.0),
                               test::icosphere(1.0, 2), test::cube_mesh(1.0, 1)}) {
        EXPECT_NO_THROW(validate(resolve(task, shape).analysis)) << shape.size() << " points";
    }
}

TEST_P(AutoParametersFor, NameEachValueItsOriginAndItsRule) {
    const ResolvedParameters resolved = resolve(task, shape_named("cube", 1000, 0.02));
    EXPECT_GE(resolved.values.size(), 5U);
    for (const ResolvedValue& value : resolved.values) {
        EXPECT_TRUE(value.automatic) << value.name;
        EXPECT_FALSE(value.rule.empty()) << value.name;
        EXPECT_TRUE(std::isfinite(value.value)) << value.name;
    }
}

TEST_P(AutoParametersFor, LeaveWhatTheUserGave) {
    ParameterRequest request;
    request.radius = 0.321;
    request.atoms = 7;
    request.lambda = 0.123;
    request.pattern_points = 793;
    request.analysis_iterations = 4;
    request.random_seed = 99;
    const ResolvedParameters resolved = resolve(task, shape_named("cube", 1000, 0.02), request);
    EXPECT_EQ(resolved.analysis.radius, 0.321);
    EXPECT_EQ(resolved.analysis.atoms, 7);
    EXPECT_EQ(resolved.analysis.lambda, 0.123);
    EXPECT_EQ(resolved.analysis.pattern.points, 793);
    EXPECT_EQ(resolved.analysis.iterations, 4);
    EXPECT_EQ(resolved.analysis.random_seed, 99U);
    for (const auto* name : {"radius", "atoms", "lambda", "patternPoints", "analysisIterations"}) {
        EXPECT_FALSE(value_named(resolved, name).automatic) << name;
    }
}

TEST_P(AutoParametersFor, ScaleWithTheShape) {
    Shape shape = shape_named("sphere", 3000, 0.02);
    const ResolvedParameters once = resolve(task, shape);
    shape.cloud.points *= 1000;
    const ResolvedParameters scaled = resolve(task, shape);
    EXPECT_NEAR(scaled.analysis.radius, 1000 * once.analysis.radius, 1e-3 * scaled.analysis.radius);
    EXPECT_NEAR(scaled.analysis.lambda, once.analysis.lambda, 1e-3 * once.analysis.lambda);
}

TEST_P(AutoParametersFor, TakePatternAndAtomsFromADictionary) {
    ParameterRequest request;
    request.dictionary = Dictionary(Pattern::grid(8), 5);
    request.keep_dictionary = true;
    const ResolvedParameters resolved = resolve(task, shape_named("cube", 1000, 0.02), request);
    EXPECT_EQ(resolved.analysis.atoms, 5);
    EXPECT_TRUE(resolved.analysis.keep_dictionary);
    ASSERT_TRUE(resolved.analysis.initial_dictionary.has_value());
    EXPECT_NO_THROW(validate(resolved.analysis));
}

INSTANTIATE_TEST_SUITE_P(Tasks, AutoParametersFor,
                         testing::Values(Task::Denoise, Task::Resample, Task::Analyze),
                         [](const auto& test) {
                             switch (test.param) {
                                 case Task::Denoise: return "Denoise";
                                 case Task::Resample: return "Resample";
                                 case Task::Analyze: return "Analyze";
                             }
                             return "Unknown";
                         });

TEST(AutoParameters, TheRadiusGrowsWithTheNoise) {
    const double quiet =
        resolve(Task::Denoise, shape_named("sphere", 20000, 0.005)).analysis.radius;
    const double noisy = resolve(Task::Denoise, shape_named("sphere", 20000, 0.08)).analysis.radius;
    EXPECT_GT(noisy, 1.3 * quiet);
    EXPECT_GT(noisy, 2 * 0.08);
}

TEST(AutoParameters, ProbeTheTrianglesOfAMeshButNotWhenDenoising) {
    const Shape mesh = test::icosphere(1.0, 3);
    EXPECT_EQ(resolve(Task::Resample, mesh).analysis.probing, ProbingKind::NearestTriangle);
    EXPECT_NE(resolve(Task::Denoise, mesh).analysis.probing, ProbingKind::NearestTriangle);
}

TEST(AutoParameters, ResamplingTakesASpacingACountOrAFactor) {
    const Shape shape = shape_named("sphere", 1000, 0.0);
    ParameterRequest request;
    EXPECT_EQ(resolve(Task::Resample, shape, request).resample.target_points, 1000U);
    request.factor = 4.0;
    EXPECT_EQ(resolve(Task::Resample, shape, request).resample.target_points, 4000U);
    request.factor.reset();
    request.target_points = 1234;
    EXPECT_EQ(resolve(Task::Resample, shape, request).resample.target_points, 1234U);
    request.target_points.reset();
    request.target_spacing = 0.07;
    const ResampleParams spaced = resolve(Task::Resample, shape, request).resample;
    EXPECT_EQ(spaced.target_spacing, 0.07);
    EXPECT_EQ(spaced.target_points, 0U);
}

TEST(AutoParameters, RefuseTwoTargets) {
    ParameterRequest request;
    request.factor = 2.0;
    request.target_points = 500;
    try {
        (void)resolve(Task::Resample, shape_named("sphere", 1000, 0.0), request);
        FAIL() << "no exception";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
    }
}

TEST(AutoParameters, WarnOfARadiusThatIsTooSmallOrTooLarge) {
    const Shape shape = shape_named("sphere", 1000, 0.0);
    ParameterRequest request;
    EXPECT_TRUE(resolve(Task::Analyze, shape, request).warnings.empty());
    request.radius = 1e-4;
    EXPECT_FALSE(resolve(Task::Analyze, shape, request).warnings.empty());
    request.radius = 2.0;
    EXPECT_FALSE(resolve(Task::Analyze, shape, request).warnings.empty());
}

TEST(AutoParameters, DenoiseAShapeOfUnknownUnit) {
    // What a bare upload gets: nothing given, coordinates in any unit.
    for (const auto* name : {"plane", "sphere", "cube"}) {
        const test::TestShape truth =
            test::make_shape(name, {.points = 10000, .noise = 0.02, .seed = 5});
        Shape shape;
        shape.cloud.points = truth.points;
        const DenoiseParams params = resolve(Task::Denoise, shape).denoise;
        const Points result = denoise(shape, params, {.threads = 2}).points;
        const double before = test::error_to_shape(truth.points, truth).rmse;
        const double after = test::error_to_shape(result, truth).rmse;
        const double factor = name == std::string("cube") ? 1.4 : 2.0;  // edges are rounded
        EXPECT_LT(factor * after, before) << name << ": " << before << " -> " << after;
    }
}

TEST(AutoParameters, ResampleExactPlanesToTheNumberAskedFor) {
    const Shape cube = shape_named("cube", 6000, 0.0);
    ParameterRequest request;
    request.factor = 4;
    const ResampleParams params = resolve(Task::Resample, cube, request).resample;
    const double count = static_cast<double>(resample(cube, params, {.threads = 2}).points.cols());
    EXPECT_NEAR(count, 24000, 0.02 * 24000);
}

}  // namespace
}  // namespace lpf
