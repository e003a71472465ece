#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>

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

    /// Weights of points, and where they are summed.
    struct Sum {
        const float* weight;
        Values* values;
    };
    static constexpr std::size_t kMostSums = 4;

    /// Shares weights of n points out among the cells, for up to kMostSums sums at once.
    void add(const float* x, const float* y, std::size_t n, std::initializer_list<Sum> sums) const {
        const float* weight[kMostSums];
        std::fill_n(weight, kMostSums, sums.begin()->weight);
        std::ranges::transform(sums, weight, &Sum::weight);
        std::array<float, kMostSums * kSide * kSide> together{};
        kernels::add_to_four(image(*sums.begin()->values), x, y, weight, n, together.data());
        std::size_t first = 0;
        for (const Sum& sum : sums) {
            for (std::size_t k = 0; k < sum.values->size(); ++k) {
                (*sum.values)[k] += together[kMostSums * k + first];
            }
            ++first;
        }
    }

    /// The values at n places.
    void read(const Values& values, const float* x, const float* y, std::size_t n,
              float* out) const {
        kernels::read_image(image(values), x, y, n, out);
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
