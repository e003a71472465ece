#include "core/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <stop_token>

#include "core/auto_parameters.h"
#include "core/base/error.h"
#include "tests/core/clouds.h"
#include "tests/support/meshes.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

ResampleParams params_for(double radius) {
    ResampleParams params;
    params.analysis.radius = radius;
    params.analysis.iterations = 2;
    params.analysis.atoms = 8;
    params.analysis.lambda = 0.02;
    return params;
}

Shape cloud_of(const Points& points) {
    Shape shape;
    shape.cloud.points = points;
    return shape;
}

ErrorCode code_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.code();
    }
    ADD_FAILURE() << "no exception";
    return ErrorCode::Internal;
}

void expect_rows_agree(const ResampleResult& result, std::size_t input_size) {
    const auto n = static_cast<std::size_t>(result.points.cols());
    ASSERT_GT(n, 0U);
    ASSERT_EQ(result.source.size(), n);
    ASSERT_EQ(result.field.size(), n);
    ASSERT_TRUE(result.points.allFinite());
    for (std::size_t i = 0; i < n; ++i) {
        ASSERT_LT(result.source[i], input_size);
        ASSERT_LT(result.field[i], result.analysis.frames.size());
    }
}

void expect_same_for_any_threads(const Points& points, const ResampleParams& params) {
    const ResampleResult one = resample(cloud_of(points), params, {.threads = 1});
    for (const int threads : {2, 5}) {
        const ResampleResult many = resample(cloud_of(points), params, {.threads = threads});
        ASSERT_EQ(many.points, one.points);
        ASSERT_EQ(many.source, one.source);
        ASSERT_EQ(many.field, one.field);
    }
}

class ResampleOf : public testing::TestWithParam<std::string> {
protected:
    const test::TestShape shape = test::make_shape(GetParam(), {.points = 3000});
    ResampleParams params = params_for(0.25);
};

TEST_P(ResampleOf, KeepsTheSpacing) {
    for (const double spacing : {0.03, 0.05, 0.2}) {
        params.target_spacing = spacing;
        const ResampleResult result = resample(cloud_of(shape.points), params, {});
        EXPECT_EQ(result.spacing, spacing);
        if (result.points.cols() < 2) continue;
        EXPECT_GE(test::nearest_neighbour_stats(result.points).min, spacing * (1 - 1e-9));
    }
}

TEST_P(ResampleOf, StaysOnTheShapeAndCoversIt) {
    params.target_spacing = 0.05;
    params.support = 0.1;
    const ResampleResult result = resample(cloud_of(shape.points), params, {.threads = 2});
    EXPECT_LT(test::error_to_shape(result.points, shape).rmse, 0.03);
    EXPECT_LT(test::coverage(shape.clean, result.points), 1.5 * 0.05);
}

TEST_P(ResampleOf, NamesTheNearestInputPointAndAFieldNearby) {
    params.target_spacing = 0.1;
    const ResampleResult result = resample(cloud_of(shape.points), params, {});
    expect_rows_agree(result, 3000);
    const test::CloudDistance to_input(shape.points);
    for (Eigen::Index i = 0; i < result.points.cols(); ++i) {
        const Eigen::Vector3d point = result.points.col(i);
        const auto row = static_cast<std::size_t>(i);
        ASSERT_NEAR((point - shape.points.col(result.source[row])).norm(), to_input(point), 1e-9);
        ASSERT_LT((point - result.analysis.frames[result.field[row]].centre).norm(), 3 * 0.25);
    }
}

TEST_P(ResampleOf, DoesNotDependOnTheNumberOfThreads) {
    params.target_spacing = 0.06;
    expect_same_for_any_threads(shape.points, params);
}

TEST_P(ResampleOf, MeetsTheNumberOfPointsAskedForWithinTwoPercent) {
    for (const std::size_t wanted : {500U, 2500U}) {
        params.target_points = wanted;
        const ResampleResult result = resample(cloud_of(shape.points), params, {.threads = 2});
        const auto found = static_cast<double>(result.points.cols());
        EXPECT_NEAR(found / static_cast<double>(wanted), 1, 0.02) << "of " << wanted;
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, ResampleOf, testing::Values("plane", "sphere", "cube", "helix"));

/// Enough LPFs for several blocks, and for the spacing to be searched on a sample.
class LargeResample : public testing::Test {
protected:
    LargeResample() {
        params.analysis.iterations = 1;
        params.analysis.learning_sample = 500;
        params.target_points = 60000;
    }

    const test::TestShape shape =
        test::make_shape("cube_with_curve", {.points = 60000, .noise = 0.002});
    ResampleParams params = params_for(0.04);
};

TEST_F(LargeResample, MeetsTheNumberOfPointsWithinTwoPercent) {
    const ResampleResult result = resample(cloud_of(shape.points), params, {.threads = 2});
    ASSERT_GT(result.analysis.frames.size(), 32000U);  // a search does not hold their candidates
    EXPECT_NEAR(static_cast<double>(result.points.cols()) / 60000, 1, 0.02);
    EXPECT_GE(test::nearest_neighbour_stats(result.points).min, result.spacing * (1 - 1e-9));
}

TEST_F(LargeResample, DoesNotDependOnTheNumberOfThreads) {
    expect_same_for_any_threads(shape.points, params);
}

TEST(Resample, SurvivesStrayPointsFarAway) {
    Points points = test::make_sphere({.points = 3000}).points;
    const Points near = points;
    points.conservativeResize(3, points.cols() + 2);
    points.rightCols(2) << 1e12, -1e7, 0.0, 1e7, -1e12, 3.0;
    ResampleParams params = params_for(0.25);
    params.target_spacing = 0.05;
    const ResampleResult result = resample(cloud_of(points), params, {.threads = 2});
    expect_rows_agree(result, 3002);
    EXPECT_LT(test::coverage(near, result.points), 1.5 * 0.05);
    EXPECT_GE(test::nearest_neighbour_stats(result.points).min, 0.05 * (1 - 1e-9));
}

TEST(Resample, OfAPlaneIsAlmostAsDenseAsCanBe) {
    const Points plane = test::make_plane({.points = 8000}).points;
    ResampleParams params = params_for(0.3);
    params.target_spacing = 0.04;
    const auto stats = test::nearest_neighbour_stats(resample(cloud_of(plane), params, {}).points);
    EXPECT_LT(stats.mean, 1.3 * 0.04);
    EXPECT_LT(stats.max, 2 * 0.04);
}

TEST(Resample, SupportKeepsItFromGoingBeyondABorder) {
    const Points plane = test::make_plane({.points = 4000}).points;
    ResampleParams params = params_for(0.3);
    params.target_spacing = 0.04;
    params.support = 0.06;
    const Points result = resample(cloud_of(plane), params, {}).points;
    EXPECT_LT(result.topRows(2).cwiseAbs().maxCoeff(), 1.08);
}

TEST(Resample, DenoisesFirstWhereAskedTo) {
    const test::TestShape shape = test::make_sphere({.points = 5000, .noise = 0.03});
    ResampleParams params = params_for(0.3);
    params.target_points = 3000;
    const auto error = [&] {
        const Points result = resample(cloud_of(shape.points), params, {.threads = 2}).points;
        return test::error_to_shape(result, shape).rmse;
    };
    const double raw = error();
    params.denoise = DenoiseParams{};
    params.denoise->analysis = params.analysis;
    params.denoise->analysis.probing = ProbingKind::NoiseAware;
    EXPECT_LT(1.3 * error(), raw);
}

/// A noisy cube, resampled to four times its points with no other parameter given.
class ResampleOfANoisyCube : public testing::Test {
protected:
    ResampleOfANoisyCube() {
        ParameterRequest request;
        request.factor = 4;
        const Measurements measured = measure(cube.points, {.threads = 2});
        params = resolve_parameters(Task::Resample, shape, measured, request).resample;
    }

    const test::TestShape cube = test::make_cube({.points = 20000, .noise = 0.01, .seed = 5});
    const Shape shape = cloud_of(cube.points);
    ResampleParams params;
};

TEST_F(ResampleOfANoisyCube, PutsHardlyAPointInTheAirBesideEdges) {
    const ResampleResult result = resample(shape, params, {.threads = 2});
    int far = 0;
    for (Eigen::Index i = 0; i < result.points.cols(); ++i) {
        far += cube.distance(result.points.col(i)) > result.spacing;
    }
    EXPECT_LT(far, 0.0015 * static_cast<double>(result.points.cols()));
}

TEST_F(ResampleOfANoisyCube, KeepsTheSpacingAndTheNumberOfPoints) {
    const ResampleResult result = resample(shape, params, {.threads = 2});
    expect_rows_agree(result, shape.size());
    EXPECT_NEAR(static_cast<double>(result.points.cols()) / 80000, 1, 0.02);
    const auto nearest = test::nearest_neighbour_stats(result.points);
    EXPECT_GE(nearest.min, result.spacing * (1 - 1e-9));
    EXPECT_LT(nearest.mean, 1.25 * result.spacing);
}

TEST_F(ResampleOfANoisyCube, KeepsASpacingThatIsGiven) {
    params.target_points = 0;
    params.target_spacing = 0.02;
    const ResampleResult result = resample(shape, params, {.threads = 2});
    EXPECT_DOUBLE_EQ(result.spacing, 0.02);
    EXPECT_GE(test::nearest_neighbour_stats(result.points).min, 0.02 * (1 - 1e-9));
    EXPECT_LT(test::coverage(cube.clean, result.points), 0.02);
}

TEST_F(ResampleOfANoisyCube, DoesNotDependOnTheNumberOfThreads) {
    expect_same_for_any_threads(shape.cloud.points, params);
}

TEST(Resample, OfAMeshLiesOnItsTriangles) {
    const Shape mesh = test::icosphere(1.0, 2);
    ResampleParams params = params_for(0.4);
    params.analysis.probing = ProbingKind::NearestTriangle;
    params.analysis.lambda = 0.002;
    params.target_points = 4000;
    const ResampleResult result = resample(mesh, params, {.threads = 2});
    expect_rows_agree(result, mesh.size());
    EXPECT_NEAR(static_cast<double>(result.points.cols()) / 4000, 1, 0.02);
    const test::MeshDistance distance(mesh.cloud.points, mesh.triangles);
    const auto distances =
        test::distances_of(result.points, [&](const Eigen::Vector3d& p) { return distance(p); });
    EXPECT_LT(test::summarize(distances).rmse, 0.01);
}

TEST(Resample, WorksAtMapCoordinates) {
    const test::TestShape shape = test::make_sphere({.points = 2000});
    const Eigen::Vector3d offset(1e7, -2e7, 1e7);
    ResampleParams params = params_for(0.4);
    params.target_spacing = 0.1;
    const Points far = resample(cloud_of(shape.points.colwise() + offset), params, {}).points;
    EXPECT_LT(test::error_to_shape(far.colwise() - offset, shape).rmse, 0.03);
    EXPECT_GE(test::nearest_neighbour_stats(far).min, 0.1 * (1 - 1e-6));
}

TEST(Resample, TakesExactlyOneTarget) {
    const Shape shape = cloud_of(test::make_plane({.points = 200}).points);
    ResampleParams params = params_for(0.3);
    EXPECT_EQ(code_of([&] { (void)resample(shape, params, {}); }), ErrorCode::InvalidParameter);
    params.target_spacing = 0.1;
    params.target_points = 100;
    EXPECT_EQ(code_of([&] { (void)resample(shape, params, {}); }), ErrorCode::InvalidParameter);
}

TEST(Resample, StopsWhenCancelledInAnyPhase) {
    const Shape shape = cloud_of(test::make_sphere({.points = 2000}).points);
    ResampleParams params = params_for(0.3);
    params.target_spacing = 0.03;
    std::set<std::string> phases;
    Execution listening;
    listening.progress = [&](const Progress& p) { phases.emplace(p.phase); };
    (void)resample(shape, params, listening);
    EXPECT_GE(phases.size(), 5U);
    for (const std::string& phase : phases) {
        std::stop_source source;
        Execution execution{.stop = source.get_token()};
        execution.progress = [&](const Progress& p) {
            if (p.phase == phase) source.request_stop();
        };
        EXPECT_EQ(code_of([&] { (void)resample(shape, params, execution); }), ErrorCode::Cancelled)
            << phase;
    }
}

TEST(Resample, ReportsRisingProgressToTheEnd) {
    const Shape shape = cloud_of(test::make_sphere({.points = 2000}).points);
    ResampleParams params = params_for(0.3);
    params.target_points = 1000;
    params.denoise = DenoiseParams{.analysis = params.analysis};
    double last = 0;
    Execution execution{.threads = 2};
    execution.progress = [&](const Progress& progress) {
        EXPECT_GE(progress.fraction, last - 1e-12) << progress.phase;
        last = progress.fraction;
    };
    (void)resample(shape, params, execution);
    EXPECT_NEAR(last, 1, 1e-9);
}

class AwkwardResample : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(AwkwardResample, GivesFinitePointsOrAnError) {
    const Points& points = GetParam().points;
    ResampleParams params = params_for(0.3);
    params.target_spacing = 0.1;
    if (points.cols() < 3 || GetParam().name == "AllEqual") {
        EXPECT_THROW((void)resample(cloud_of(points), params, {}), Error);
        return;
    }
    const ResampleResult result = resample(cloud_of(points), params, {});
    EXPECT_TRUE(result.points.allFinite());
    EXPECT_EQ(result.source.size(), static_cast<std::size_t>(result.points.cols()));
}

INSTANTIATE_TEST_SUITE_P(Clouds, AwkwardResample, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

}  // namespace
}  // namespace lpf
