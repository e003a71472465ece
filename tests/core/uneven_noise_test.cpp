// All that goes by the noise of a place, on scans whose noise varies.
#include <gtest/gtest.h>

#include "core/auto_parameters.h"
#include "core/denoising/tiled_denoise.h"
#include "tests/core/clouds.h"
#include "tests/support/metrics.h"
#include "tests/support/noises.h"

namespace lpf {
namespace {

/// Noise where there is least of it [diagonal].
constexpr double kLeast = 0.0015;

struct Scan {
    test::TestShape exact;
    Shape cloud;
    Measurements measured;

    explicit Scan(const std::string& name)
        : exact(test::make_shape(name, {.points = 30000})),
          cloud{{test::with_uneven_noise(exact.points, kLeast * test::diagonal_of(exact.points))
                     .points,
                 {}},
                {}},
          measured(measure(cloud.cloud.points, {.threads = 2})) {}

    [[nodiscard]] DenoiseParams to_denoise() const {
        return resolve_parameters(Task::Denoise, cloud, measured, {}).denoise;
    }
    [[nodiscard]] double error(const Points& points) const {
        return test::error_to_shape(points, exact).rmse;
    }
    [[nodiscard]] double error_before() const { return error(cloud.cloud.points); }
};

class DenoiseUneven : public testing::TestWithParam<std::string> {};

TEST_P(DenoiseUneven, TakesMostOfTheNoiseAway) {
    const Scan scan(GetParam());
    const Points points = denoise(scan.cloud, scan.to_denoise(), {.threads = 2}).points;
    EXPECT_LT(scan.error(points), 0.25 * scan.error_before());
}

TEST_P(DenoiseUneven, IsNoWorseWhereThereIsLittleNoise) {
    const Scan scan(GetParam());
    const Points points = denoise(scan.cloud, scan.to_denoise(), {.threads = 2}).points;
    const double low = scan.exact.points.row(0).minCoeff();
    const double high = scan.exact.points.row(0).maxCoeff();
    std::vector<std::uint8_t> quiet;
    for (const double x : scan.exact.points.row(0)) quiet.push_back(x < low + (high - low) / 4);
    const double before = test::error_to_shape(scan.cloud.cloud.points, scan.exact, quiet).rmse;
    EXPECT_LT(test::error_to_shape(points, scan.exact, quiet).rmse, 0.5 * before);
}

INSTANTIATE_TEST_SUITE_P(Shapes, DenoiseUneven,
                         testing::Values("sphere", "cube", "curve_on_surface", "helix"),
                         [](const auto& test) { return test.param; });

TEST(UnevenScan, IsDenoisedTheSameByAnyNumberOfThreads) {
    const Scan scan("cube");
    const DenoiseParams params = scan.to_denoise();
    const Points one = denoise(scan.cloud, params, {.threads = 1}).points;
    for (const int threads : {2, 5}) {
        EXPECT_EQ(denoise(scan.cloud, params, {.threads = threads}).points, one) << threads;
    }
}

TEST(UnevenScan, IsDenoisedAsWellInTiles) {
    const Scan scan("cube");
    const DenoiseParams params = scan.to_denoise();
    const Points whole = denoise(scan.cloud, params, {.threads = 2}).points;
    const TiledDenoising done = denoise_tiles(PointsInMemory(scan.cloud.cloud.points), params,
                                              {.threads = 2}, {.points = 4000});
    const Points tiled = test::moved(scan.cloud.cloud.points, done.moves);
    EXPECT_LT(scan.error(tiled), 1.1 * scan.error(whole));
}

TEST(UnevenScan, IsResampledWithoutItsNoise) {
    const Scan scan("sphere");
    ParameterRequest request;
    request.factor = 2;
    const ResampleParams params =
        resolve_parameters(Task::Resample, scan.cloud, scan.measured, request).resample;
    const Points points = resample(scan.cloud, params, {.threads = 2}).points;
    EXPECT_NEAR(static_cast<double>(points.cols()) / 60000, 1, 0.02);
    EXPECT_LT(scan.error(points), 0.25 * scan.error_before());
    EXPECT_LT(test::coverage(scan.exact.points, points), 0.02);
}

}  // namespace
}  // namespace lpf
