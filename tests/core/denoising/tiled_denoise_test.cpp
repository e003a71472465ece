#include "core/denoising/tiled_denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stop_token>

#include "core/auto_parameters.h"
#include "core/base/error.h"
#include "core/shape/tiling.h"
#include "tests/core/clouds.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

constexpr TilingParams kSmallTiles{
    .points = 6000, .patches = 12, .patch_points = 3000, .count_duplicates = true};

/// A noisy shape with its automatic parameters.
struct Scan {
    test::TestShape shape;
    DenoiseParams params;
    Shape cloud;

    explicit Scan(const std::string& name, std::size_t points = 40'000, double noise = 0.02)
        : shape(test::make_shape(name, {.points = points, .noise = noise, .seed = 4})),
          cloud{{shape.points, {}}, {}} {
        const Measurements measured = measure(shape.points, {});
        params = resolve_parameters(Task::Denoise, cloud, measured, {}).denoise;
    }

    [[nodiscard]] TiledDenoising tiled(int threads = 2) const {
        return denoise_tiles(PointsInMemory(shape.points), params, {.threads = threads},
                             kSmallTiles);
    }
};

struct Case {
    std::string shape;
    std::size_t points;
    double noise;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.shape; }

class TiledDenoiseOf : public testing::TestWithParam<Case> {};

/// Which points of a scan are near the borders of its tiles, where a seam would be.
std::vector<std::uint8_t> near_borders(const Scan& scan) {
    const PointsInMemory source(scan.shape.points);
    const Partition partition(make_sketch(source, {}), static_cast<double>(kSmallTiles.points));
    EXPECT_GE(partition.boxes().size(), 7U);
    std::vector<std::uint8_t> near(scan.cloud.size(), 0);
    for (std::size_t i = 0; i < near.size(); ++i) {
        int tiles = 0;
        partition.for_each_near(scan.shape.points.col(static_cast<Eigen::Index>(i)),
                                0.3 * scan.params.analysis.radius, [&](std::uint32_t) { ++tiles; });
        near[i] = tiles > 1;
    }
    return near;
}

TEST_P(TiledDenoiseOf, IsAsGoodAsTheWholeAndHasNoSeams) {
    Scan scan(GetParam().shape, GetParam().points, GetParam().noise);
    const std::vector<std::uint8_t> near = near_borders(scan);
    double of_whole = 0;
    double of_tiles = 0;
    double near_whole = 0;
    double near_tiles = 0;
    // Seeds are others in tiles: on a few thousand points they change the error by a tenth.
    for (const std::uint64_t draw : {1, 2, 3, 4}) {
        scan.params.analysis.random_seed = draw;
        const Points whole = denoise(scan.cloud, scan.params, {.threads = 2}).points;
        const Points tiled = test::moved(scan.shape.points, scan.tiled().moves);
        of_whole += test::error_to_shape(whole, scan.shape).rmse;
        of_tiles += test::error_to_shape(tiled, scan.shape).rmse;
        near_whole += test::error_to_shape(whole, scan.shape, near).rmse;
        const test::ErrorStats here = test::error_to_shape(tiled, scan.shape, near);
        near_tiles += here.rmse;
        EXPECT_GT(here.count, 500U);
    }
    EXPECT_LT(of_tiles, 1.05 * of_whole);
    EXPECT_LT(near_tiles, 1.06 * near_whole);
}

INSTANTIATE_TEST_SUITE_P(Shapes, TiledDenoiseOf,
                         testing::Values(Case{"cube", 40'000, 0.02}, Case{"sphere", 40'000, 0.02},
                                         Case{"curvenet", 100'000, 0.1}),
                         [](const auto& test) { return test.param.shape; });

TEST(TiledDenoise, KnowsAllFieldsOnce) {
    const Scan scan("sphere");
    const AnalysisResult whole = denoise(scan.cloud, scan.params, {.threads = 2}).analysis;
    const AnalysisResult tiled = scan.tiled().analysis;
    EXPECT_EQ(tiled.codes.size(), tiled.frames.size());
    EXPECT_EQ(tiled.residuals.size(), tiled.frames.size());
    EXPECT_EQ(tiled.dimensions.size(), tiled.frames.size());
    EXPECT_EQ(tiled.usage, usage_of_atoms(tiled.codes));
    ASSERT_EQ(tiled.energy.size(), whole.energy.size());
    EXPECT_LE(tiled.energy[0].pose, tiled.energy[0].learning);
    EXPECT_GT(tiled.energy[0].pose, 0.5 * whole.energy[0].pose);
    EXPECT_EQ(tiled.radius, whole.radius);
}

TEST(TiledDenoise, HasAboutAsManyFieldsAsTheWhole) {
    Scan scan("sphere");
    double whole = 0;
    double tiled = 0;
    // Of one draw of seeds alone, tiles have 2 to 6 % more.
    std::uint64_t& draw = scan.params.analysis.random_seed;
    for (draw = 1; draw <= 4; ++draw) {
        const auto analysis = denoise(scan.cloud, scan.params, {.threads = 2}).analysis;
        whole += static_cast<double>(analysis.frames.size());
        tiled += static_cast<double>(scan.tiled().analysis.frames.size());
    }
    EXPECT_NEAR(tiled, whole, 0.05 * whole);
}

TEST(TiledDenoise, DoesNotDependOnTheNumberOfThreads) {
    const Scan scan("cube", 20'000);
    const TiledDenoising one = scan.tiled(1);
    for (const int threads : {2, 5, 9}) {
        const TiledDenoising other = scan.tiled(threads);
        EXPECT_EQ(other.moves, one.moves);
        EXPECT_EQ(other.rms_moves, one.rms_moves);
        EXPECT_EQ(other.analysis.codes.values(), one.analysis.codes.values());
    }
}

TEST(TiledDenoise, MovesByTheRmsThatItTells) {
    const Scan scan("cube", 20'000);
    const TiledDenoising tiled = scan.tiled();
    double sum = 0;
    for (const Eigen::Vector3f& move : tiled.moves) sum += move.cast<double>().squaredNorm();
    ASSERT_EQ(tiled.rms_moves.size(), 1U);
    EXPECT_NEAR(tiled.rms_moves[0], std::sqrt(sum / 20'000), 1e-6 * tiled.rms_moves[0]);
}

TEST(TiledDenoise, ASecondIterationStartsFromWhereTheFirstEnded) {
    Scan scan("sphere", 20'000);
    scan.params.iterations = 2;
    scan.params.stop_ratio = 0;
    scan.params.least_bent = 0;
    const TiledDenoising tiled = scan.tiled();
    ASSERT_EQ(tiled.rms_moves.size(), 2U);
    EXPECT_LT(tiled.rms_moves[1], 0.5 * tiled.rms_moves[0]);
    const DenoiseResult whole = denoise(scan.cloud, scan.params, {.threads = 2});
    EXPECT_LT(test::error_to_shape(test::moved(scan.shape.points, tiled.moves), scan.shape).rmse,
              1.05 * test::error_to_shape(whole.points, scan.shape).rmse);
}

TEST(TiledDenoise, PointsThatAreNotFiniteStay) {
    Scan scan("cube", 20'000);
    const TiledDenoising clean = scan.tiled();
    Points points(3, 20'001);
    points << scan.shape.points, Eigen::Vector3d(1, std::numeric_limits<double>::quiet_NaN(), 2);
    scan.shape.points = points;
    const TiledDenoising tiled = scan.tiled();
    EXPECT_EQ(tiled.moves.back(), Eigen::Vector3f(0, 0, 0));
    EXPECT_EQ(std::vector(tiled.moves.begin(), tiled.moves.end() - 1), clean.moves);
}

TEST(TiledDenoise, CountsDuplicatesOnce) {
    Scan scan("cube", 20'000);
    EXPECT_EQ(scan.tiled().duplicates, 0U);
    for (Eigen::Index i = 0; i < 100; ++i) {
        scan.shape.points.col(19'000 + i) = scan.shape.points.col(150 * i);
    }
    EXPECT_EQ(scan.tiled().duplicates, 100U);
}

TEST(TiledDenoise, AGivenDictionaryIsKept) {
    Scan scan("cube", 20'000);
    scan.params.analysis.initial_dictionary =
        denoise(scan.cloud, scan.params, {.threads = 2}).analysis.dictionary;
    scan.params.analysis.keep_dictionary = true;
    const TiledDenoising tiled = scan.tiled();
    EXPECT_EQ(tiled.analysis.dictionary.gram(), scan.params.analysis.initial_dictionary->gram());
}

TEST(TiledDenoise, SaysWhatCannotBeDone) {
    Scan scan("cube", 20'000);
    scan.shape.points = Points::Ones(3, 50);
    EXPECT_THROW((void)scan.tiled(), Error);
    scan.shape.points = Points::Ones(3, 2);
    EXPECT_THROW((void)scan.tiled(), Error);
    scan.params.iterations = 0;
    EXPECT_THROW((void)scan.tiled(), Error);
}

TEST(TiledDenoise, StopsWhenAsked) {
    const Scan scan("cube", 20'000);
    std::stop_source stop;
    const Execution execution{
        .threads = 2, .stop = stop.get_token(), .progress = [&](const Progress& progress) {
            if (progress.unit == "tiles") stop.request_stop();
        }};
    try {
        (void)denoise_tiles(PointsInMemory(scan.shape.points), scan.params, execution, kSmallTiles);
        ADD_FAILURE() << "no exception";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
}

TEST(TiledDenoise, ProgressOnlyRises) {
    const Scan scan("sphere", 20'000);
    double last = 0;
    const Execution execution{.threads = 2, .progress = [&](const Progress& progress) {
                                  EXPECT_GE(progress.fraction, last);
                                  last = progress.fraction;
                              }};
    (void)denoise_tiles(PointsInMemory(scan.shape.points), scan.params, execution, kSmallTiles);
    EXPECT_GT(last, 0.95);
    EXPECT_LE(last, 1.0);
}

}  // namespace
}  // namespace lpf
