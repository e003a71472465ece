// Experiments of the paper that are small enough to run with every build.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/auto_parameters.h"
#include "tests/support/meshes.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

/// Resamples with the request given, everything else automatic.
ResampleResult resample_with(const Shape& shape, const ParameterRequest& request) {
    const Execution execution{.threads = 2};
    const Measurements measured = measure(shape.cloud.points, execution);
    return resample(shape, resolve_parameters(Task::Resample, shape, measured, request).resample,
                    execution);
}

struct PlaneCase {
    int grid;
    double mean;  // of the nearest-neighbour distances, as the paper found it
};

class PaperPlane : public testing::TestWithParam<PlaneCase> {};

/// Sec. 4.1, Fig. "plane": a randomly sampled plane, resampled with the same radius and patterns of
/// three densities. The paper's r = 1 is the diameter of the pattern.
TEST_P(PaperPlane, NearestNeighboursAreAsFarApartAsThePaperFound) {
    const PlaneCase& experiment = GetParam();
    const test::TestShape plane = test::make_plane({.points = 60000, .seed = 11});
    ParameterRequest request;
    request.radius = 0.5;
    request.pattern_points = Pattern::grid(experiment.grid).size();
    request.target_spacing = 1.0 / experiment.grid;
    const ResampleResult result = resample_with({{plane.points, {}}, {}}, request);

    const auto stats = test::nearest_neighbour_stats(result.points);
    EXPECT_NEAR(stats.mean, experiment.mean, 0.15 * experiment.mean);
    // The histogram is that of Poisson disks: nothing below the spacing, a peak just above it, and
    // hardly anything beyond twice the spacing.
    const double spacing = *request.target_spacing;
    EXPECT_GE(*std::ranges::min_element(stats.distances), spacing * (1 - 1e-6));
    const auto near = std::ranges::count_if(
        stats.distances, [&](double distance) { return distance < 1.25 * spacing; });
    EXPECT_GE(static_cast<double>(near), 0.9 * static_cast<double>(stats.distances.size()));
    EXPECT_LE(*std::ranges::max_element(stats.distances), 2 * spacing);
}

INSTANTIATE_TEST_SUITE_P(Patterns, PaperPlane,
                         testing::Values(PlaneCase{16, 0.075}, PlaneCase{32, 0.032},
                                         PlaneCase{64, 0.015}),
                         [](const auto& each) { return "Grid" + std::to_string(each.param.grid); });

/// Sec. 4.1, Fig. "Fandisk", on a mesh that is made here: the edges of a mesh stay sharp.
TEST(PaperMesh, ResamplingKeepsTheEdgesOfAMesh) {
    const Shape cube = test::cube_mesh();
    const double diagonal =
        (cube.cloud.points.rowwise().maxCoeff() - cube.cloud.points.rowwise().minCoeff()).norm();
    ParameterRequest request;
    request.radius = 0.03 * diagonal;
    request.pattern_points = 793;
    request.target_points = 60000;
    const ResampleResult result = resample_with(cube, request);

    EXPECT_NEAR(static_cast<double>(result.points.cols()), 60000, 0.02 * 60000);
    const test::MeshDistance distance(cube.cloud.points, cube.triangles);
    double squares = 0;
    double largest = 0;
    for (Eigen::Index i = 0; i < result.points.cols(); ++i) {
        const double d = distance(result.points.col(i));
        squares += d * d;
        largest = std::max(largest, d);
    }
    EXPECT_LE(std::sqrt(squares / static_cast<double>(result.points.cols())), 5e-4 * diagonal);
    EXPECT_LE(largest, result.spacing) << "a rounded edge or a point between two faces";
    // A point near each corner: rounding would cut the corners first.
    for (Eigen::Index v = 0; v < cube.cloud.points.cols(); ++v) {
        const double gap =
            (result.points.colwise() - cube.cloud.points.col(v)).colwise().norm().minCoeff();
        EXPECT_LE(gap, 1.5 * result.spacing) << "vertex " << v;
    }
}

/// What is sparser than the rest is resampled too, if only by the points that it has.
TEST(Resampling, LosesNoSparsePart) {
    Points points(3, 20005);
    points.leftCols(20000) = test::make_plane({.points = 20000, .seed = 5}).points;
    for (Eigen::Index i = 0; i < 5; ++i) {
        points.col(20000 + i) << 3.0 + 0.5 * static_cast<double>(i), 0.0, 1.0;
    }
    ParameterRequest request;
    request.factor = 1.0;
    const ResampleResult result = resample_with({{points, {}}, {}}, request);
    for (Eigen::Index i = 0; i < 5; ++i) {
        const double gap =
            (result.points.colwise() - points.col(20000 + i)).colwise().norm().minCoeff();
        EXPECT_LE(gap, 1e-3) << "isolated point " << i;
    }
}

}  // namespace
}  // namespace lpf
