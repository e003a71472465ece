#include "server/shapes/examination.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace lpf::server {
namespace {

/// A noisy wave over the unit square.
Shape wave(int count) {
    Shape shape;
    shape.cloud.points.resize(3, count);
    Random random(5);
    for (Eigen::Index i = 0; i < count; ++i) {
        const double x = random.uniform(0, 10);
        const double y = random.uniform(0, 10);
        shape.cloud.points.col(i) =
            Eigen::Vector3d(x, y, 0.3 * std::sin(x) + 0.01 * random.normal());
    }
    return shape;
}

TEST(Examination, OfASmallShapeIsOfTheWhole) {
    const Shape shape = wave(3000);
    const ShapePart part = part_of_shape(shape, 3000);
    EXPECT_TRUE(part.is_whole());
    EXPECT_EQ(part.shape.cloud.points, shape.cloud.points);
}

TEST(Examination, OfAPartTellsOfTheWhole) {
    const Shape shape = wave(60'000);
    const ShapePart whole = part_of_shape(shape, 100'000);
    const ShapePart part = part_of_shape(shape, 20'000);
    EXPECT_FALSE(part.is_whole());
    EXPECT_NEAR(part.share, 1.0 / 3, 0.12);
    const Measurements expected = measure_part(whole, 60'000, 0.0, {});
    const Measurements measured = measure_part(part, 60'000, expected.diagonal, {});
    EXPECT_EQ(measured.points, 60'000U);
    EXPECT_EQ(measured.diagonal, expected.diagonal);
    EXPECT_NEAR(measured.mean_spacing, expected.mean_spacing, 0.1 * expected.mean_spacing);
    EXPECT_NEAR(measured.density_radius, expected.density_radius, 0.1 * expected.density_radius);
    const ResolvedParameters parameters =
        resolve_parameters(Task::Denoise, shape, expected, ParameterRequest{});
    const Findings all = examine(whole, parameters, {});
    const Findings some = examine(part, parameters, {});
    EXPECT_NEAR(some.fields, all.fields, 0.3 * all.fields);
    EXPECT_NEAR(some.points_per_field, all.points_per_field, 0.2 * all.points_per_field);
    EXPECT_NEAR(some.probed_points, 60'000, 1);
}

TEST(Examination, FindsDuplicatesOutliersAndNeighbours) {
    Shape shape = wave(5000);
    for (Eigen::Index i = 0; i < 500; ++i)
        shape.cloud.points.col(i) = shape.cloud.points.col(i + 500);
    shape.cloud.points.col(2000) = Eigen::Vector3d(50, 50, 50);
    const ShapePart part = part_of_shape(shape, 10'000);
    ParameterRequest request;
    request.radius = 0.5;
    const ResolvedParameters parameters =
        resolve_parameters(Task::Denoise, shape, measure_part(part, 5000, 0.0, {}), request);
    const Findings found = examine(part, parameters, {});
    EXPECT_EQ(found.duplicates, 500);
    EXPECT_GE(found.outliers, 1);
    EXPECT_LT(found.outliers, 20);
    ASSERT_EQ(found.neighbours.size(), 2000U);
    EXPECT_TRUE(std::ranges::is_sorted(found.neighbours));
    // 50 points a unit of area, 0.785 units of area in a disk.
    EXPECT_NEAR(found.neighbours[1000], 38, 8);
}

TEST(Examination, OfAPartOfAMeshKeepsTheFacesInIt) {
    Shape shape = wave(40'000);
    shape.triangles.resize(3, 10'000);
    for (std::uint32_t f = 0; f < 10'000; ++f) shape.triangles.col(f) << f, f, f;
    const ShapePart part = part_of_shape(shape, 10'000);
    EXPECT_GT(part.shape.triangles.cols(), 500);
    EXPECT_LT(part.shape.triangles.cols(), 10'000);
    EXPECT_LT(part.shape.triangles.maxCoeff(), part.shape.size());
}

}  // namespace
}  // namespace lpf::server
