#include "core/field/density_map.h"

#include <algorithm>
#include <cmath>

namespace lpf {
namespace {

/// The raster covers the target area, a little more than the disk.
constexpr float kHalfWidth = 1.1F;

constexpr float kLeastDensity = 0.001F;

}  // namespace

DensityMap::Place DensityMap::place(float x, float y) const {
    const auto cell = [](float value) {
        const float at = (value + kHalfWidth) / (2 * kHalfWidth) * kCells + 0.5F;
        return std::clamp(at, 0.0F, kCells + 0.99F);
    };
    const float column = cell(x);
    const float row = along_curve_ ? 0.0F : cell(y);
    const int i = static_cast<int>(column);
    const int j = static_cast<int>(row);
    return {j * kSide + i, column - static_cast<float>(i), row - static_cast<float>(j)};
}

void DensityMap::count(const Piece& piece, const TargetArea& flattened, float reach) {
    along_curve_ = piece.is_curve();
    cells_.fill(0.0F);
    for (std::size_t i = 0; i < flattened.size; ++i) {
        const float x = flattened.x[i];
        const float y = flattened.y[i];
        const float height = std::abs(flattened.z[i]) - piece.half_gap(x, y);
        const float across = along_curve_ ? y : 0.0F;
        if (height * height + across * across > reach * reach) continue;
        const Place p = place(x, y);
        float* cell = &cells_[static_cast<std::size_t>(p.cell)];
        cell[0] += (1 - p.right) * (1 - p.up);
        cell[1] += p.right * (1 - p.up);
        cell[kSide] += (1 - p.right) * p.up;
        cell[kSide + 1] += p.right * p.up;
    }
    float sum = 0;
    float squares = 0;
    for (const float count : cells_) {
        sum += count;
        squares += count * count;
    }
    level_ = sum > 0 ? squares / sum : 0.0F;
}

float DensityMap::at(float x, float y) const {
    if (level_ == 0) return 1.0F;
    const Place p = place(x, y);
    const float* cell = &cells_[static_cast<std::size_t>(p.cell)];
    const float density = (1 - p.up) * ((1 - p.right) * cell[0] + p.right * cell[1]) +
                          p.up * ((1 - p.right) * cell[kSide] + p.right * cell[kSide + 1]);
    return std::clamp(density / level_, kLeastDensity, 1.0F);
}

}  // namespace lpf
