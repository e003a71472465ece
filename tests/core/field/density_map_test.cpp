#include "core/field/density_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace lpf {
namespace {

/// Points of the unit disk, as far as they are wanted, on the plane of a piece.
template <typename Wanted>
TargetArea disk(const Wanted& wanted) {
    TargetArea target;
    target.reserve(20000);
    Random random(3, 3);
    for (int i = 0; i < 20000; ++i) {
        const auto x = static_cast<float>(random.uniform(-1, 1));
        const auto y = static_cast<float>(random.uniform(-1, 1));
        if (std::hypot(x, y) > 1 || !wanted(x, y)) continue;
        target.x[target.size] = x;
        target.y[target.size] = y;
        target.z[target.size] = 0;
        ++target.size;
    }
    return target;
}

Piece flat(Dimension dimension) {
    Piece piece;
    piece.dimension = dimension;
    return piece;
}

float density_at(const DensityMap& map, float x, float y) {
    float density = -1.0F;
    map.read(&x, &y, 1, &density);
    return density;
}

TEST(DensityMap, IsFullWhereAllIsEven) {
    DensityMap map;
    map.count(flat(kSurface), disk([](float, float) { return true; }), 0.1F);
    for (const float x : {-0.5F, 0.0F, 0.4F}) {
        for (const float y : {-0.5F, 0.0F, 0.4F}) EXPECT_GT(density_at(map, x, y), 0.85F);
    }
}

TEST(DensityMap, IsHalfAtABorderAndNearlyNothingBeyondIt) {
    DensityMap map;
    map.count(flat(kSurface), disk([](float x, float) { return x < 0; }), 0.1F);
    EXPECT_GT(density_at(map, -0.4F, 0.1F), 0.85F);
    EXPECT_NEAR(density_at(map, 0.0F, 0.1F), 0.5F, 0.15F);
    EXPECT_LT(density_at(map, 0.4F, 0.1F), 0.01F);
    EXPECT_GE(density_at(map, 0.4F, 0.1F), 0.0F);
}

TEST(DensityMap, IsLessWhereManyOtherPointsAreOnSurfacesAlone) {
    TargetArea target = disk([](float, float) { return true; });
    for (std::size_t i = 1; i < target.size; i += 2) {
        if (target.x[i] > 0) target.z[i] = 0.5F;  // half of the points there are off the piece
    }
    DensityMap map;
    map.count(flat(kSurface), target, 0.1F);
    const float left = density_at(map, -0.5F, 0.0F);
    EXPECT_NEAR(density_at(map, 0.5F, 0.0F), 0.25F * left, 0.05F);  // half as dense, half a share
}

TEST(DensityMap, LooksAlongACurveOnly) {
    DensityMap map;
    map.count(flat(kCurve), disk([](float x, float y) { return x < 0 && std::abs(y) < 0.05F; }),
              0.1F);
    EXPECT_GT(density_at(map, -0.5F, 0.9F), 0.85F);
    EXPECT_LT(density_at(map, 0.5F, 0.0F), 0.01F);
}

TEST(DensityMap, CountsMembersAlone) {
    TargetArea target = disk([](float, float) { return true; });
    for (std::size_t i = 0; i < target.size; ++i) {
        if (target.x[i] > 0) target.z[i] = 0.2F;
    }
    DensityMap map;
    map.count(flat(kSurface), target, 0.1F);
    EXPECT_LT(density_at(map, 0.4F, 0.0F), 0.01F);
    Piece two_sheets = flat(kSurface);
    two_sheets.sheets[0] = 0.04F;  // the higher half is one of them, the lower is neither
    map.count(two_sheets, target, 0.1F);
    EXPECT_GT(density_at(map, 0.4F, 0.0F), 0.85F);
    EXPECT_LT(density_at(map, -0.4F, 0.0F), 0.01F);
}

TEST(DensityMap, IsFullWithoutMembers) {
    DensityMap map;
    map.count(flat(kSurface), TargetArea{}, 0.1F);
    EXPECT_EQ(density_at(map, 0.3F, 0.3F), 1.0F);
}

}  // namespace
}  // namespace lpf
