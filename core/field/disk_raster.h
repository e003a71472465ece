#pragma once

#include <array>
#include <cstddef>

#include "core/base/vote_kernels.h"

namespace lpf {

/// Cells over the target area of an LPF, or along its curve, that points add to and that are read
/// bilinearly: what an LPF says place by place.
class DiskRaster {
public:
    static constexpr int kCells = 12;
    static constexpr int kSide = kCells + 2;
    using Values = std::array<float, kSide * kSide>;

    explicit DiskRaster(bool along_curve = false) : along_curve_(along_curve) {}

    /// Shares the weights of n points out among the cells.
    void add(const float* x, const float* y, const float* weight, std::size_t n,
             Values& values) const {
        kernels::add_to_image(image(values), x, y, weight, n, values.data());
    }

    /// The values at n places.
    void read(const Values& values, const float* x, const float* y, std::size_t n,
              float* out) const {
        kernels::read_image(image(values), 1, x, y, n, &out);
    }

private:
    /// The raster covers the target area, a little more than the disk.
    static constexpr float kHalfWidth = 1.1F;

    [[nodiscard]] kernels::Image image(const Values& values) const {
        constexpr float kScale = kCells / (2 * kHalfWidth);
        constexpr float kMiddle = kCells / 2.0F + 0.5F;
        return {.values = values.data(),
                .columns = kSide,
                .rows = kSide,
                .scale_x = kScale,
                .offset_x = kMiddle,
                .scale_y = along_curve_ ? 0.0F : kScale,
                .offset_y = along_curve_ ? 0.0F : kMiddle};
    }

    bool along_curve_;
};

}  // namespace lpf
