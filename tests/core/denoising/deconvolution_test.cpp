#include "core/denoising/deconvolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/auto_parameters.h"
#include "core/denoise.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr double kNoise = 0.05;

Points deconvolved(const Points& scan, Points shape, const Region& region = {}, int threads = 2) {
    (void)deconvolve(scan, kNoise, region, shape, {.threads = threads});
    return shape;
}

/// A cube as LPFs see it that bend where noise does: rounded edges.
Points rounded(const test::TestShape& cube) {
    Points points = cube.clean;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        std::vector<double> depth;  // under the two faces that are not the point's own
        for (int axis = 0; axis < 3; ++axis) depth.push_back(1 - std::abs(points(axis, i)));
        for (int axis = 0; axis < 3; ++axis) {
            double inwards = 0;
            for (int other = 0; other < 3; ++other) {
                if (other == axis || depth[static_cast<std::size_t>(axis)] > 1e-9) continue;
                const double d = depth[static_cast<std::size_t>(other)] / kNoise;
                inwards += 0.8 * kNoise * std::exp(-d * d / 2);
            }
            points(axis, i) -= std::copysign(inwards, points(axis, i));
        }
    }
    return points;
}

test::TestShape noisy_cube() {
    return test::make_cube({.points = 150000, .noise = kNoise, .seed = 3});
}

double error_at_edges(const Points& points, const test::TestShape& cube) {
    return test::error_by_part(points, cube, 3 * kNoise).near_edges.rmse;
}

TEST(Deconvolution, SharpensRoundedEdges) {
    const test::TestShape cube = noisy_cube();
    const Points before = rounded(cube);
    const Points after = deconvolved(cube.points, before);
    EXPECT_GT(error_at_edges(before, cube), 0.1 * kNoise);
    EXPECT_LT(error_at_edges(after, cube), 0.8 * error_at_edges(before, cube));
}

TEST(Deconvolution, LeavesFlatPartsAsTheyAre) {
    const test::TestShape cube = noisy_cube();
    const Points before = cube.clean;
    const Points after = deconvolved(cube.points, before);
    std::size_t off_edges = 0;
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
        if ((1 - before.col(i).array().abs() > 8 * kNoise).count() < 2) continue;
        ++off_edges;
        ASSERT_EQ(after.col(i), before.col(i));
    }
    EXPECT_GT(off_edges, 10000U);
}

TEST(Deconvolution, TellsNearSheetsApart) {
    // Two and a half sigma apart, each drawn towards the other.
    const test::TestShape plate =
        test::make_thin_plate({.points = 80000, .noise = kNoise, .seed = 4}, 2.5 * kNoise);
    Points before = plate.clean;
    before.row(2) *= 0.6;
    const Points after = deconvolved(plate.points, before);
    EXPECT_NEAR(test::error_to_shape(before, plate).rmse, 0.5 * kNoise, 1e-9);
    EXPECT_LT(test::error_to_shape(after, plate).rmse, 0.25 * kNoise);
}

TEST(Deconvolution, PointsBetweenSheetsGoToOne) {
    const test::TestShape plate =
        test::make_thin_plate({.points = 80000, .noise = kNoise, .seed = 4}, 4 * kNoise);
    Points before = plate.clean;
    std::vector<std::uint8_t> is_stray(80000, 0);
    for (std::size_t i = 0; i < is_stray.size(); i += 200) {
        is_stray[i] = 1;
        before(2, static_cast<Eigen::Index>(i)) *= 0.3;
    }
    const Points after = deconvolved(plate.points, before);
    EXPECT_GT(test::error_to_shape(before, plate, is_stray).rmse, kNoise);
    EXPECT_LT(test::error_to_shape(after, plate, is_stray).rmse, 0.2 * kNoise);
}

TEST(Deconvolution, PointsFarFromTheRegionStay) {
    const test::TestShape cube = noisy_cube();
    const Points before = rounded(cube);
    const Box corner{Eigen::Vector3d::Constant(0.8), Eigen::Vector3d::Constant(1.2)};
    const Points after = deconvolved(cube.points, before, {corner});
    const Points everywhere = deconvolved(cube.points, before);
    const double reach = kReachOfDeconvolution * kNoise;
    double most_within = 0;
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
        if (corner.distance_to(before.col(i)) > reach) {
            ASSERT_EQ(after.col(i), before.col(i));
        } else if (corner.holds(before.col(i))) {
            most_within = std::max(most_within, (after.col(i) - everywhere.col(i)).norm());
        }
    }
    EXPECT_NE(after, before);
    EXPECT_LT(most_within, 0.2 * kNoise);
}

TEST(Deconvolution, TellsWhichPointsAreNotOnFlatParts) {
    const test::TestShape cube = noisy_cube();
    Points shape = rounded(cube);
    const Points before = shape;
    const auto bent = deconvolve(cube.points, kNoise, {}, shape, {.threads = 2});
    std::vector<std::uint8_t> is_bent(150000, 0);
    for (const std::uint32_t i : bent) is_bent[i] = 1;
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
        ASSERT_TRUE(is_bent[static_cast<std::size_t>(i)] || shape.col(i) == before.col(i));
    }
    EXPECT_GT(bent.size(), 30000U);
    EXPECT_LT(bent.size(), 90000U);
}

TEST(Deconvolution, IsTheSameForAnyNumberOfThreads) {
    const test::TestShape cube = noisy_cube();
    const Points before = rounded(cube);
    const Points one = deconvolved(cube.points, before, {}, 1);
    EXPECT_EQ(deconvolved(cube.points, before, {}, 2), one);
    EXPECT_EQ(deconvolved(cube.points, before, {}, 5), one);
}

TEST(Deconvolution, LosesNothingFarFromTheOrigin) {
    const test::TestShape cube = noisy_cube();
    const Eigen::Vector3d far(1e6, -1e6, 1e6);
    const Points near_by = deconvolved(cube.points, rounded(cube));
    const Points far_off =
        deconvolved(cube.points.colwise() + far, rounded(cube).colwise() + far).colwise() - far;
    EXPECT_NEAR(error_at_edges(far_off, cube), error_at_edges(near_by, cube), 0.002 * kNoise);
}

TEST(Deconvolution, FewPointsAreLeftAlone) {
    const test::TestShape cube = test::make_cube({.points = 500, .noise = kNoise, .seed = 3});
    EXPECT_EQ(deconvolved(cube.points, cube.clean), cube.clean);
    const Points one = Points::Zero(3, 1);
    EXPECT_EQ(deconvolved(one, one), one);
}

TEST(Deconvolution, EndsTheFirstOuterIterationIfThatTakesTheFullStep) {
    const test::TestShape cube = noisy_cube();
    const Shape shape{{cube.points, {}}, {}};
    const Measurements measured = measure(cube.points, {.threads = 2});
    DenoiseParams params = resolve_parameters(Task::Denoise, shape, measured, {}).denoise;
    ASSERT_EQ(params.iterations, 2);
    const Points full = denoise(shape, params, {.threads = 2}).points;
    params.iterations = 1;
    const Points once = denoise(shape, params, {.threads = 2}).points;
    params.gamma = 1e9;  // as good as full, but asked for
    const Points rounded = denoise(shape, params, {.threads = 2}).points;
    EXPECT_LT(error_at_edges(once, cube), 0.85 * error_at_edges(rounded, cube));
    EXPECT_LT(error_at_edges(full, cube), 0.85 * error_at_edges(once, cube));
}

}  // namespace
}  // namespace lpf
