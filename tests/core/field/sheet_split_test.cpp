#include "core/field/sheet_split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/random.h"
#include "core/field/piece_fit.h"

namespace lpf {
namespace {

constexpr float kExtent = 1.1F;
constexpr float kNoise = 0.1F;
constexpr float kSigmas = 6.0F;

/// What split_sheets makes of one surface that is fitted to noisy points over the disk.
/// @param height of the shape, above or below the middle
Piece split(const std::function<float(float x, bool above)>& height) {
    TargetArea target;
    target.reserve(5000);
    Random random(7, 1);
    for (int i = 0; i < 5000; ++i) {
        const auto x = static_cast<float>(random.uniform(-1, 1));
        const auto y = static_cast<float>(random.uniform(-1, 1));
        const auto noise = static_cast<float>(random.normal());
        if (std::hypot(x, y) > 1) continue;
        target.x[target.size] = x;
        target.y[target.size] = y;
        target.z[target.size] = height(x, i % 2 == 0) + kNoise * noise;
        ++target.size;
    }
    PieceSample sample;
    sample.assign(target, 100000, kExtent, 2.0F, kExtent);
    Piece piece;
    piece.dimension = kSurface;
    piece.noise = kNoise;
    piece.reach = kSigmas * kNoise;
    sample.look_along(piece, sample.size());
    sample.measure(piece, sample.size());
    fit_smooth(sample, sample.size(), piece);
    sample.measure(piece, sample.size());
    estimate_error(sample, piece);
    split_sheets(sample, kSigmas, piece);
    return piece;
}

TEST(SheetSplit, FindsTwoSheetsThatNoiseHides) {
    const Piece piece = split([](float, bool above) { return above ? 0.15F : -0.15F; });
    EXPECT_NEAR(piece.half_gap(0, 0), 0.15F, 0.02F);
}

TEST(SheetSplit, FindsSheetsThatComeTogether) {
    const Piece piece =
        split([](float x, bool above) { return (above ? 1.0F : -1.0F) * (0.18F + 0.08F * x); });
    EXPECT_GT(piece.half_gap(0.5F, 0), piece.half_gap(-0.5F, 0) + 0.03F);
}

TEST(SheetSplit, LeavesOneSurfaceAlone) {
    EXPECT_EQ(split([](float, bool) { return 0.0F; }).sheets[0], 0.0F);
}

TEST(SheetSplit, LeavesAWaveAloneThatNoParabolaFollows) {
    // Its heights have two modes, too, but each at a place of its own.
    EXPECT_EQ(
        split([](float x, bool) { return 0.2F * (std::sin(9 * x) > 0 ? 1.0F : -1.0F); }).sheets[0],
        0.0F);
}

}  // namespace
}  // namespace lpf
