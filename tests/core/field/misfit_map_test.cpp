#include "core/field/misfit_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

constexpr float kNoise = 0.04F;

using Height = std::function<float(float x, float y)>;

/// Noisy points of the unit disk at the given height off a piece.
TargetArea disk(const Height& height) {
    TargetArea target;
    target.reserve(20000);
    Random random(3, 3);
    for (int i = 0; i < 20000; ++i) {
        const auto x = static_cast<float>(random.uniform(-1, 1));
        const auto y = static_cast<float>(random.uniform(-1, 1));
        const auto z = static_cast<float>(random.normal());
        if (std::hypot(x, y) > 1) continue;
        target.x[target.size] = x;
        target.y[target.size] = y;
        target.z[target.size] = height(x, y) + kNoise * z;
        ++target.size;
    }
    return target;
}

Piece flat() {
    Piece piece;
    piece.dimension = kSurface;
    piece.noise = kNoise;
    piece.reach = 6 * kNoise;
    return piece;
}

/// The map of points at some height about a piece whose field says another.
MisfitMap map_of(const Piece& piece, const Height& height, const Height& field) {
    const TargetArea target = disk(height);
    std::vector<float> y(target.size);
    std::vector<float> z(target.size);
    for (std::size_t i = 0; i < target.size; ++i) z[i] = field(target.x[i], target.y[i]);
    MisfitMap map;
    map.measure({piece, target}, y.data(), z.data());
    return map;
}

float misfit_at(const MisfitMap& map, float x, float y) {
    float misfit = -1.0F;
    map.read(&x, &y, 1, &misfit);
    return misfit;
}

float nothing(float, float) { return 0.0F; }

TEST(MisfitMap, IsEmptyWhereNoiseExplainsAll) {
    const MisfitMap map = map_of(flat(), nothing, nothing);
    for (const float x : {-0.5F, 0.0F, 0.4F}) {
        for (const float y : {-0.5F, 0.0F, 0.4F}) {
            EXPECT_LT(misfit_at(map, x, y), 0.05F * kNoise * kNoise);
        }
    }
}

TEST(MisfitMap, IsTheSquaredDistanceOfTheMeansWhereTheFieldDoesNotSuitThePoints) {
    const Height bump = [](float x, float) { return x > 0.1F ? 2 * kNoise : 0.0F; };
    const MisfitMap map = map_of(flat(), bump, nothing);
    EXPECT_NEAR(misfit_at(map, 0.5F, 0.0F), 4 * kNoise * kNoise, 0.6F * kNoise * kNoise);
    EXPECT_LT(misfit_at(map, -0.5F, 0.0F), 0.05F * kNoise * kNoise);
}

TEST(MisfitMap, FollowsTheField) {
    const Height wave = [](float x, float) { return 2 * kNoise * std::sin(4 * x); };
    const MisfitMap map = map_of(flat(), wave, wave);
    for (const float x : {-0.6F, -0.2F, 0.4F}) {
        EXPECT_LT(misfit_at(map, x, 0.1F), 0.05F * kNoise * kNoise);
    }
}

TEST(MisfitMap, IsMeasuredAcrossASteepSurface) {
    Piece steep = flat();
    steep.steepness = 2.0F;
    const MisfitMap map = map_of(
        steep, [](float, float) { return 3 * kNoise; }, nothing);
    EXPECT_NEAR(misfit_at(map, 0.2F, 0.2F), 9 * kNoise * kNoise / 4, 0.4F * kNoise * kNoise);
}

TEST(MisfitMap, LooksAtMembersAlone) {
    const Height other = [](float x, float) { return x > 0 ? 12 * kNoise : 0.0F; };
    EXPECT_LT(misfit_at(map_of(flat(), other, nothing), 0.5F, 0.0F), 0.5F * kNoise * kNoise);
}

TEST(MisfitMap, LooksAtTheNearerOfTwoSheets) {
    Piece sheets = flat();
    sheets.sheets[0] = 0.09F;
    const Height both = [](float x, float) {
        return std::fmod(std::abs(100 * x), 2) < 1 ? .3F : -.3F;
    };
    EXPECT_LT(misfit_at(map_of(sheets, both, nothing), 0.3F, 0.0F), 0.05F * kNoise * kNoise);
}

TEST(MisfitMap, OfACurveLooksAlongItOnly) {
    Piece curve = flat();
    curve.dimension = kCurve;
    TargetArea target = disk([](float x, float) { return x > 0 ? 2 * kNoise : 0.0F; });
    for (std::size_t i = 0; i < target.size; ++i) target.y[i] = 0;
    const std::vector<float> zeros(target.size, 0.0F);
    MisfitMap map;
    map.measure({curve, target}, zeros.data(), zeros.data());
    EXPECT_NEAR(misfit_at(map, 0.5F, 0.9F), 4 * kNoise * kNoise, 0.6F * kNoise * kNoise);
    EXPECT_LT(misfit_at(map, -0.5F, 0.0F), 0.05F * kNoise * kNoise);
}

}  // namespace
}  // namespace lpf
