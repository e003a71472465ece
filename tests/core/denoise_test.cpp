#include "core/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stop_token>

#include "core/auto_parameters.h"
#include "core/base/error.h"
#include "tests/core/clouds.h"
#include "tests/support/metrics.h"
#include "tests/support/noises.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

namespace lpf {
namespace {

DenoiseParams noise_aware(double radius) {
    DenoiseParams params;
    params.analysis.radius = radius;
    params.analysis.probing = ProbingKind::NoiseAware;
    params.analysis.iterations = 1;
    params.analysis.atoms = 8;
    return params;
}

Shape cloud_of(const Points& points) {
    Shape shape;
    shape.cloud.points = points;
    return shape;
}

Points denoised(const Points& points, const DenoiseParams& params, int threads = 2) {
    return denoise(cloud_of(points), params, {.threads = threads}).points;
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

/// A shape, how it is sampled, and by what factor the error has to fall at least.
struct Case {
    std::string shape;
    std::size_t points;
    double noise;
    double radius;
    double factor;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.shape; }

class DenoiseOf : public testing::TestWithParam<Case> {
protected:
    const Case& c = GetParam();
    const test::TestShape shape =
        test::make_shape(c.shape, {.points = c.points, .noise = c.noise, .seed = 3});
};

TEST_P(DenoiseOf, BringsThePointsNearerToTheShape) {
    const double before = test::error_to_shape(shape.points, shape).rmse;
    const Points result = denoised(shape.points, noise_aware(c.radius));
    const double after = test::error_to_shape(result, shape).rmse;
    EXPECT_LT(after * c.factor, before) << before << " -> " << after;
}

TEST_P(DenoiseOf, KeepsTheOrderOfThePoints) {
    // Row i stays within reach of where row i was: nothing is permuted.
    const Points result = denoised(shape.points, noise_aware(c.radius));
    ASSERT_EQ(result.cols(), shape.points.cols());
    EXPECT_LT(test::displacement(shape.points, result).rmse, 3 * c.noise);
    EXPECT_LT(test::displacement(shape.points, result).max, 2 * c.radius);
}

TEST_P(DenoiseOf, LeavesNoHoles) {
    const Points result = denoised(shape.points, noise_aware(c.radius));
    const double before = test::coverage(shape.clean, shape.points);
    EXPECT_LT(test::coverage(shape.clean, result), 1.5 * before + c.noise);
}

TEST_P(DenoiseOf, DoesNotDependOnTheNumberOfThreads) {
    const Points one = denoised(shape.points, noise_aware(c.radius), 1);
    EXPECT_EQ(denoised(shape.points, noise_aware(c.radius), 2), one);
    EXPECT_EQ(denoised(shape.points, noise_aware(c.radius), 5), one);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, DenoiseOf,
    testing::Values(Case{"plane", 4000, 0.03, 0.3, 4}, Case{"sphere", 6000, 0.03, 0.3, 3},
                    Case{"cube", 8000, 0.03, 0.2, 2.0}, Case{"fin", 8000, 0.02, 0.1, 1.5},
                    Case{"helix", 2000, 0.03, 0.4, 2.5}, Case{"circle", 2000, 0.03, 0.3, 2.5},
                    Case{"open_sheet", 5000, 0.03, 0.3, 2.5},
                    Case{"density_step", 5000, 0.03, 0.3, 3}),
    [](const auto& test) {
        std::string name;
        for (const char letter : test.param.shape) {
            if (letter != '_') name += letter;
        }
        return name;
    });

TEST(Denoise, LeavesAnExactPlaneWhereItIs) {
    const Points plane = test::make_plane({.points = 2000}).points;
    const Points result = denoised(plane, noise_aware(0.3));
    EXPECT_LT(result.row(2).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Denoise, TakesNoiseAwayThatIsNotGaussian) {
    const test::TestShape sphere = test::make_sphere({.points = 10000});
    const Points even = test::with_even_noise(sphere.points, 0.02);
    for (const Points& points : {even, test::rounded(sphere.points, 0.06)}) {
        const Measurements measured = measure(points, {.threads = 2});
        const DenoiseParams params =
            resolve_parameters(Task::Denoise, cloud_of(points), measured, {}).denoise;
        const double before = test::error_to_shape(points, sphere).rmse;
        const double after = test::error_to_shape(denoised(points, params), sphere).rmse;
        EXPECT_LT(after, 0.15 * before);
    }
}

TEST(Denoise, LeavesIsolatedPointsWhereTheyAre) {
    const test::TestShape shape = test::make_isolated_points({.points = 3000, .noise = 0.02});
    const Points result = denoised(shape.points, noise_aware(0.2));
    const test::CloudDistance to_cloud(shape.points);
    int isolated = 0;
    for (Eigen::Index i = 0; i < result.cols(); ++i) {
        // Farther from every other point than a target area is wide: nobody can vote for it.
        if (to_cloud.to_others(shape.points.col(i), static_cast<std::uint32_t>(i)) < 0.5) continue;
        ++isolated;
        EXPECT_EQ(Eigen::Vector3d(result.col(i)), Eigen::Vector3d(shape.points.col(i)));
    }
    EXPECT_GT(isolated, 3);
}

TEST(Denoise, WorksAtMapCoordinatesAsNearTheOrigin) {
    const test::TestShape shape = test::make_sphere({.points = 3000, .noise = 0.03});
    const Eigen::Vector3d offset(1e7, -2e7, 1e7);
    const Points near = denoised(shape.points, noise_aware(0.3));
    const Points far = denoised(shape.points.colwise() + offset, noise_aware(0.3));
    EXPECT_LT(test::displacement(near, far.colwise() - offset).rmse, 1e-3);
}

TEST(Denoise, ScalesWithTheShape) {
    const test::TestShape shape = test::make_sphere({.points = 2000, .noise = 0.03});
    const Points once = denoised(shape.points, noise_aware(0.3));
    const Points scaled = denoised(1024.0 * shape.points, noise_aware(0.3 * 1024));
    EXPECT_LT(test::displacement(once, scaled / 1024.0).max, 1e-4);
}

TEST(Denoise, DuplicatesDoNotTearApart) {
    const Points plane = test::make_plane({.points = 1500, .noise = 0.03}).points;
    const Points result = denoised(plane.replicate(1, 2), noise_aware(0.3));
    ASSERT_TRUE(result.allFinite());
    EXPECT_LT((result.leftCols(1500) - result.rightCols(1500)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Denoise, KeepsTheThicknessOfRodsThatNoiseHides) {
    const double noise = 0.02;
    const test::PiecePtr rod =
        test::union_surface({test::capsule({-1, 0, 0}, {1, 0.3, 0}, 2 * noise)});
    const auto scan = test::sampled({"rod", {rod}}, {.points = 1500, .noise = noise, .seed = 3});
    DenoiseParams params = noise_aware(0.2);
    params.analysis.noise = noise;
    params.iterations = 1;
    const Points points = denoised(scan.points, params);
    EXPECT_LT(test::error_to_shape(points, scan).rmse, 0.35 * noise);
    const auto covered = test::coverage_of_shape(scan, points, 2000);
    EXPECT_LT(covered.surface, test::coverage_of_shape(scan, scan.points, 2000).surface);
}

TEST(Denoise, SharpVotingKeepsEdgesBetter) {
    const test::TestShape shape = test::make_cube({.points = 12000, .noise = 0.015});
    DenoiseParams params = noise_aware(0.25);
    const auto edge_error = [&] {
        const Points result = denoised(shape.points, params);
        double sum = 0;
        int count = 0;
        for (Eigen::Index i = 0; i < result.cols(); ++i) {
            const Eigen::Array3d far = 1 - shape.clean.col(i).array().abs();
            if ((far < 0.08).count() < 2) continue;  // near an edge
            sum += std::pow(shape.distance(result.col(i)), 2);
            ++count;
        }
        return std::sqrt(sum / count);
    };
    const double smooth = edge_error();
    params.sharp = true;
    EXPECT_LT(edge_error(), smooth);
}

TEST(Denoise, TheShareOfTheStepIsGammaOverOnePlusGamma) {
    const Points noisy = test::make_sphere({.points = 2000, .noise = 0.03}).points;
    DenoiseParams params = noise_aware(0.3);
    params.iterations = 1;
    const Points full = denoised(noisy, params);
    for (const double gamma : {0.5, 1.0, 4.0}) {
        params.gamma = gamma;
        const Points part = denoised(noisy, params);
        const Points expected = noisy + gamma / (1 + gamma) * (full - noisy);
        EXPECT_LT(test::displacement(expected, part).max, 1e-9) << "gamma " << gamma;
    }
}

TEST(Denoise, RunsTheIterationsAskedForOrStopsWhenLittleMoves) {
    const Shape shape = cloud_of(test::make_sphere({.points = 2000, .noise = 0.03}).points);
    DenoiseParams params = noise_aware(0.3);
    params.iterations = 3;
    params.stop_ratio = 0;
    const DenoiseResult all = denoise(shape, params, {});
    EXPECT_EQ(all.rms_moves.size(), 3U);
    EXPECT_LT(all.rms_moves[1], all.rms_moves[0]);
    params.stop_ratio = 0.99;
    EXPECT_EQ(denoise(shape, params, {}).rms_moves.size(), 2U);
}

TEST(Denoise, ASecondIterationFollowsWhereMuchIsNotFlat) {
    const auto iterations = [](const Points& points) {
        const Shape shape = cloud_of(points);
        const Measurements measured = measure(points, {.threads = 2});
        const auto params = resolve_parameters(Task::Denoise, shape, measured, {}).denoise;
        return denoise(shape, params, {.threads = 2}).rms_moves.size();
    };
    EXPECT_EQ(iterations(test::make_plane({.points = 40000, .noise = 0.02}).points), 1U);
    EXPECT_EQ(iterations(test::make_cube({.points = 40000, .noise = 0.05}).points), 2U);
}

TEST(Denoise, ReportsTheRmsOfItsMoves) {
    const Points noisy = test::make_plane({.points = 1500, .noise = 0.03}).points;
    DenoiseParams params = noise_aware(0.3);
    params.iterations = 1;
    const DenoiseResult result = denoise(cloud_of(noisy), params, {});
    EXPECT_NEAR(result.rms_moves[0], test::displacement(noisy, result.points).rmse, 1e-9);
}

TEST(Denoise, RefusesWhatItCannotWorkOn) {
    const DenoiseParams params = noise_aware(0.3);
    Points points = test::make_plane({.points = 100}).points;
    EXPECT_EQ(code_of([&] { (void)denoised(points.leftCols(2), params); }),
              ErrorCode::TooFewPoints);
    EXPECT_EQ(code_of([&] { (void)denoised(Points::Ones(3, 50), params); }),
              ErrorCode::DegenerateShape);
    points(2, 7) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(code_of([&] { (void)denoised(points, params); }), ErrorCode::InvalidParameter);
}

TEST(Denoise, RefusesParametersOutOfRange) {
    const Points points = test::make_plane({.points = 100}).points;
    DenoiseParams params = noise_aware(0.3);
    params.iterations = 0;
    EXPECT_EQ(code_of([&] { (void)denoised(points, params); }), ErrorCode::InvalidParameter);
    params = noise_aware(0.3);
    params.gamma = -1;
    EXPECT_EQ(code_of([&] { (void)denoised(points, params); }), ErrorCode::InvalidParameter);
    params = noise_aware(0.3);
    params.analysis.probing = ProbingKind::NearestTriangle;
    EXPECT_EQ(code_of([&] { (void)denoised(points, params); }), ErrorCode::InvalidParameter);
}

TEST(Denoise, StopsWhenCancelled) {
    std::stop_source source;
    Execution execution{.stop = source.get_token()};
    int reports = 0;
    execution.progress = [&](const Progress&) {
        if (++reports == 6) source.request_stop();
    };
    const Shape shape = cloud_of(test::make_sphere({.points = 3000, .noise = 0.03}).points);
    EXPECT_EQ(code_of([&] { (void)denoise(shape, noise_aware(0.3), execution); }),
              ErrorCode::Cancelled);
}

TEST(Denoise, ReportsRisingProgress) {
    double last = 0;
    Execution execution{.threads = 2};
    execution.progress = [&](const Progress& progress) {
        EXPECT_GE(progress.fraction, last - 1e-12);
        last = progress.fraction;
    };
    const Shape shape = cloud_of(test::make_sphere({.points = 2000, .noise = 0.03}).points);
    (void)denoise(shape, noise_aware(0.3), execution);
    EXPECT_GT(last, 0.4);
    EXPECT_LE(last, 1 + 1e-12);
}

class AwkwardDenoise : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(AwkwardDenoise, GivesFinitePointsOrAnError) {
    const Points& points = GetParam().points;
    for (const double radius : {1e-6, 0.3, 1e3}) {
        for (const auto probing : {ProbingKind::AsOrthogonalAsPossible, ProbingKind::NoiseAware}) {
            DenoiseParams params = noise_aware(radius);
            params.analysis.probing = probing;
            if (points.cols() < 3 || GetParam().name == "AllEqual") {
                EXPECT_THROW((void)denoised(points, params), Error);
                continue;
            }
            const Points result = denoised(points, params);
            ASSERT_TRUE(result.allFinite());
            ASSERT_EQ(result.cols(), points.cols());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, AwkwardDenoise, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

}  // namespace
}  // namespace lpf
