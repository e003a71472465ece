#include "core/shape/noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "tests/core/clouds.h"
#include "tests/support/metrics.h"
#include "tests/support/noises.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

TEST(Measure, KnowsTheExtentAndTheNumberOfPoints) {
    const Points points = test::random_box(500, 1, 0, 2);
    const Measurements measured = measure(points, {});
    EXPECT_EQ(measured.points, 500U);
    EXPECT_NEAR(measured.diagonal, test::diagonal_of(points), 1e-12);
}

TEST(Measure, MeanSpacingAgreesWithBruteForce) {
    const Points points = test::make_sphere({.points = 2000}).points;
    EXPECT_NEAR(measure(points, {}).mean_spacing, test::nearest_neighbour_stats(points).mean, 1e-9);
}

TEST(Measure, MeanSpacingOfASampleIsAboutThatOfAll) {
    const Points points = test::make_plane({.points = 30000}).points;
    const double exact = test::nearest_neighbour_stats(points).mean;
    EXPECT_NEAR(measure(points, {}).mean_spacing, exact, 0.05 * exact);
}

TEST(Measure, ALargeCloudIsMeasuredOnPartsOfIt) {
    Points points = test::make_sphere({.points = 1'500'000, .noise = 0.01}).points.colwise() +
                    Eigen::Vector3d(3, 0, 0);
    const Measurements whole = measure(points, {.threads = 2});
    points(1, 77) = std::numeric_limits<double>::quiet_NaN();
    const Measurements parts = measure(PointsInMemory(points), {.threads = 2});
    EXPECT_EQ(parts.points, 1'499'999U);
    EXPECT_NEAR(parts.diagonal, whole.diagonal, 1e-9);
    EXPECT_NEAR(parts.mean_spacing, whole.mean_spacing, 0.03 * whole.mean_spacing);
    EXPECT_NEAR(parts.density_radius, whole.density_radius, 0.03 * whole.density_radius);
    EXPECT_NEAR(parts.noise, whole.noise, 0.03 * whole.noise);
}

TEST(Measure, DuplicatesDoNotCountAsNeighbours) {
    const Points points = test::make_plane({.points = 1000}).points;
    const double once = measure(points, {}).mean_spacing;
    EXPECT_NEAR(measure(points.replicate(1, 3), {}).mean_spacing, once, 1e-9);
}

TEST(Measure, DensityRadiusHoldsAbout150Points) {
    const Points points = test::make_plane({.points = 10000}).points;
    const double radius = measure(points, {}).density_radius;
    // Away from borders a disk of the radius holds density x area points.
    EXPECT_NEAR(10000 / 4.0 * 3.14159 * radius * radius, 150, 15);
}

TEST(Measure, SheetsThatNoiseHidesAreNotTakenForNoise) {
    const double noise = 0.02;
    const Points plate = test::make_thin_plate({.points = 60000, .noise = noise}, 0.05).points;
    EXPECT_NEAR(measure(plate, {}).noise, noise, 0.2 * noise);
}

TEST(Measure, ThicknessOfAPlateIsNotTakenForNoise) {
    // Two sheets four sigma apart: one plane through both is 2.2 sigma from the points.
    const Points points = test::make_thin_plate({.points = 20000, .noise = 0.02}, 0.08).points;
    EXPECT_NEAR(measure(points, {}).noise, 0.02, 0.15 * 0.02);
}

TEST(Measure, EdgesAreNotTakenForNoise) {
    // A wide ball is needed; most balls that are wide enough hold an edge.
    const Points points = test::make_cube({.points = 40000, .noise = 0.2}).points;
    EXPECT_NEAR(measure(points, {}).noise, 0.2, 0.06 * 0.2);
}

TEST(Measure, ThinLimbsAreNotTakenForNoise) {
    for (const test::TestShape& body : test::make_small_bodies(3)) {
        const double noise = std::sqrt((body.points - body.clean).squaredNorm() /
                                       static_cast<double>(body.points.size()));
        EXPECT_NEAR(measure(body.points, {}).noise, noise, 0.12 * noise) << body.name;
    }
}

TEST(Measure, CurvesAreNotTakenForLessNoise) {
    double sum = 0.0;
    for (const std::uint64_t seed : {1, 2, 3}) {
        sum += measure(test::make_curvenet({100000, 0.124, seed}).points, {}).noise;
    }
    EXPECT_NEAR(sum / 3, 0.124, 0.04 * 0.124);
}

class NoiseOf : public testing::TestWithParam<double> {};

TEST_P(NoiseOf, APlaneIsMeasured) {
    const double sigma = GetParam();
    const Points points = test::make_plane({.points = 20000, .noise = sigma}).points;
    EXPECT_NEAR(measure(points, {}).noise, sigma, 0.06 * sigma);
}

TEST_P(NoiseOf, ASphereIsMeasured) {
    const double sigma = GetParam();
    const Points points = test::make_sphere({.points = 40000, .noise = sigma}).points;
    EXPECT_NEAR(measure(points, {}).noise, sigma, 0.06 * sigma);
}

INSTANTIATE_TEST_SUITE_P(Sigmas, NoiseOf, testing::Values(0.01, 0.03, 0.06), [](const auto& test) {
    return "Thousandths" + std::to_string(std::lround(1000 * test.param));
});

TEST(Measure, NoiseNeedNotBeGaussian) {
    const test::TestShape sphere = test::make_sphere({.points = 20000});
    const Points& exact = sphere.points;
    const Points off = test::random_box(20000, 4, 0.965, 1.035);
    const test::NamedCloud clouds[] = {
        {"even, off the surface", exact * off.row(0).asDiagonal()},
        {"even, in every coordinate", test::with_even_noise(exact, 0.02)},
        {"rounded", test::rounded(exact, 0.07)}};
    for (const auto& [name, points] : clouds) {
        const double noise = test::error_to_shape(points, sphere).rmse;
        EXPECT_NEAR(measure(points, {}).noise, noise, 0.1 * noise) << name;
    }
}

TEST(Measure, NoiseOfAPlaneIsTheSpreadAboutItsMean) {
    const Points points = test::make_plane({.points = 20000, .noise = 0.002}).points;
    EXPECT_NEAR(measure(points, {}).noise, 0.002, 0.06 * 0.002);
}

TEST(Measure, AHeapOfEqualPointsDoesNotCount) {
    Points points(3, 1400);
    points << test::make_plane({.points = 1000}).points, Points::Zero(3, 400);
    const double alone = measure(points.leftCols(1000), {}).mean_spacing;
    EXPECT_NEAR(measure(points, {}).mean_spacing, alone, 0.01 * alone);
}

TEST(Measure, AHeapOfEqualPointsIsNotExact) {
    // As returns of a laser that hit nothing, all at the origin.
    Points points(3, 12000);
    points << test::make_plane({.points = 10000, .noise = 0.02}).points, Points::Zero(3, 2000);
    EXPECT_NEAR(measure(points, {}).noise, 0.02, 0.1 * 0.02);
}

TEST(Measure, AnExactPlaneHasNoNoise) {
    EXPECT_LT(measure(test::make_plane({.points = 3000}).points, {}).noise, 1e-6);
}

TEST(Measure, RoundnessIsNoNoise) {
    for (const char* name : {"sphere", "open_sheet", "helix"}) {
        const Measurements measured = measure(test::make_shape(name, {.points = 8000}).points, {});
        EXPECT_LT(measured.noise, 0.02 * measured.mean_spacing) << name;
    }
}

TEST(Measure, ScalesWithTheShape) {
    const Points points = test::make_sphere({.points = 2000, .noise = 0.02}).points;
    const Measurements once = measure(points, {});
    const Measurements scaled = measure(1024 * points, {});
    EXPECT_NEAR(scaled.noise, 1024 * once.noise, 1e-3 * scaled.noise);
    EXPECT_NEAR(scaled.mean_spacing, 1024 * once.mean_spacing, 1e-6 * scaled.mean_spacing);
    EXPECT_NEAR(scaled.density_radius, 1024 * once.density_radius, 1e-6 * scaled.density_radius);
}

TEST(Measure, SurvivesMapCoordinates) {
    const Points points = test::make_sphere({.points = 2000, .noise = 0.02}).points;
    const Measurements near = measure(points, {});
    const Measurements far = measure(points.colwise() + Eigen::Vector3d(1e7, -2e7, 1e7), {});
    EXPECT_NEAR(far.noise, near.noise, 1e-3 * near.noise);
    EXPECT_NEAR(far.mean_spacing, near.mean_spacing, 1e-4 * near.mean_spacing);
}

TEST(Measure, DoesNotDependOnTheNumberOfThreads) {
    const Points points = test::make_cube({.points = 5000, .noise = 0.02}).points;
    const Measurements one = measure(points, {.threads = 1});
    const Measurements many = measure(points, {.threads = 5});
    EXPECT_EQ(one.noise, many.noise);
    EXPECT_EQ(one.mean_spacing, many.mean_spacing);
    EXPECT_EQ(one.density_radius, many.density_radius);
}

class MeasureOn : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(MeasureOn, IsFiniteAndPositiveOrAnError) {
    const Points& points = GetParam().points;
    if (points.cols() < 3 || GetParam().name == "AllEqual") {
        EXPECT_THROW((void)measure(points, {}), Error);
        return;
    }
    const Measurements measured = measure(points, {});
    EXPECT_GT(measured.diagonal, 0);
    EXPECT_GT(measured.mean_spacing, 0);
    EXPECT_GT(measured.density_radius, 0);
    EXPECT_GE(measured.noise, 0);
    EXPECT_TRUE(std::isfinite(measured.diagonal + measured.mean_spacing + measured.density_radius +
                              measured.noise));
    EXPECT_LE(measured.density_radius, measured.diagonal * (1 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Clouds, MeasureOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(Measure, PointsThatLieOnEachOtherByTheDozenHaveANoise) {
    Points points(3, 600);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points.col(i) = Eigen::Vector3d(double(i % 6), double(i % 2), 0) +
                        (i < 6 ? 1e-3 : 0.0) * Eigen::Vector3d::Ones();
    }
    const Measurements measured = measure(points, {});
    EXPECT_TRUE(std::isfinite(measured.noise));
    EXPECT_GT(measured.mean_spacing, 0);
}

TEST(Measure, OnePointBeyondAllMeasureHidesTheOthersButIsNoEnd) {
    Points points = test::random_box(500, 2);
    points.col(7) = Eigen::Vector3d(1e38, -3e37, 2e38);
    const Measurements measured = measure(points, {});
    EXPECT_TRUE(std::isfinite(measured.noise));
}

TEST(Measure, ShapesAsSmallOrAsLargeAsNumbersGoAreMeasuredToAnEnd) {
    for (const double size : {5e-324, 1e-300, 1e200, 1.7e308}) {
        const Points points = size * test::random_box(300, 4);
        try {
            (void)measure(points, {});
        } catch (const Error&) {  // too small to have an extent
        }
    }
}

}  // namespace
}  // namespace lpf
