// What measure() says of noise that varies, or seems to.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/base/random.h"
#include "core/shape/noise.h"
#include "tests/support/metrics.h"
#include "tests/support/noises.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

class UnevenNoise : public testing::TestWithParam<const char*> {};

TEST_P(UnevenNoise, IsMeasuredPlaceByPlace) {
    const Points exact = test::make_shape(GetParam(), {.points = 30000}).points;
    const test::UnevenScan scan = test::with_uneven_noise(exact, 0.0015 * test::diagonal_of(exact));
    const Measurements measured = measure(scan.points, {.threads = 2});
    ASSERT_FALSE(measured.noise_map.is_even());
    double logs = 0.0;
    for (Eigen::Index i = 0; i < scan.points.cols(); ++i) {
        const double noise = measured.noise * measured.noise_map.factor_at(scan.points.col(i));
        logs += std::pow(std::log(noise / scan.noise[static_cast<std::size_t>(i)]), 2);
    }
    EXPECT_LT(std::sqrt(logs / static_cast<double>(scan.points.cols())), 0.25)
        << "typical error of the noise at a point, as a logarithm";
}

INSTANTIATE_TEST_SUITE_P(Shapes, UnevenNoise,
                         testing::Values("plane", "sphere", "open_sheet", "helix", "curvenet"),
                         [](const auto& test) { return std::string(test.param); });

class EvenNoise : public testing::TestWithParam<std::string> {};

TEST_P(EvenNoise, IsTakenForEven) {
    for (const double spacings : {0.0, 0.5, 1.0, 3.0}) {
        const test::TestShape exact = test::make_shape(GetParam(), {.points = 20000});
        const double noise = spacings * measure(exact.points, {.threads = 2}).mean_spacing;
        const Points points =
            test::make_shape(GetParam(), {.points = 20000, .noise = noise}).points;
        EXPECT_TRUE(measure(points, {.threads = 2}).noise_map.is_even()) << spacings;
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EvenNoise, testing::ValuesIn(test::shape_names()),
                         [](const auto& test) { return test.param; });

TEST(NoiseVariation, IsNotSeenInBodiesWithThinLimbs) {
    for (const test::TestShape& body : test::make_small_bodies(3)) {
        EXPECT_TRUE(measure(body.points, {.threads = 2}).noise_map.is_even()) << body.name;
    }
}

TEST(NoiseVariation, IsNotSeenInLeavesOnATrunk) {
    Random random(3);
    Points points(3, 20000);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        Eigen::Vector3d p(random.normal(), random.normal(), random.normal());
        if (i < 5000) {  // the trunk
            p.head<2>() *= 0.2 / p.head<2>().norm();
            p.z() = random.uniform(-8, -1);
            p.head<2>() += 0.004 * Eigen::Vector2d(random.normal(), random.normal());
        }
        points.col(i) = p;
    }
    EXPECT_TRUE(measure(points, {.threads = 2}).noise_map.is_even());
}

}  // namespace
}  // namespace lpf
