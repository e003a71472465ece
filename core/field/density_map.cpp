#include "core/field/density_map.h"

#include <algorithm>
#include <cmath>

namespace lpf {
namespace {

/// The raster covers the target area, a little more than the disk.
constexpr float kHalfWidth = 1.1F;

}  // namespace

kernels::Image DensityMap::image() const {
    constexpr float kScale = kCells / (2 * kHalfWidth);
    constexpr float kMiddle = kCells / 2.0F + 0.5F;
    return {.values = cells_.data(),
            .columns = kSide,
            .rows = kSide,
            .scale_x = kScale,
            .offset_x = kMiddle,
            .scale_y = along_curve_ ? 0.0F : kScale,
            .offset_y = along_curve_ ? 0.0F : kMiddle};
}

void DensityMap::count(const Piece& piece, const TargetArea& flattened, float reach) {
    along_curve_ = piece.is_curve();
    cells_.fill(0.0F);
    std::vector<float> is_member(flattened.size);
    for (std::size_t i = 0; i < flattened.size; ++i) {
        const float y = flattened.y[i];
        const float height = std::abs(flattened.z[i]) - piece.half_gap(flattened.x[i], y);
        const float across = along_curve_ ? y : 0.0F;
        is_member[i] = height * height + across * across <= reach * reach ? 1.0F : 0.0F;
    }
    kernels::add_to_image(image(), flattened.x.data(), flattened.y.data(), is_member.data(),
                          flattened.size, cells_.data());
    float sum = 0;
    float squares = 0;
    for (const float count : cells_) {
        sum += count;
        squares += count * count;
    }
    level_ = sum > 0 ? squares / sum : 0.0F;
    for (float& count : cells_) count /= std::max(level_, 1e-9F);
}

void DensityMap::read(const float* x, const float* y, std::size_t n, float* out) const {
    if (level_ == 0) {
        std::fill_n(out, n, 1.0F);
        return;
    }
    kernels::read_image(image(), 1, x, y, n, &out);
}

}  // namespace lpf
