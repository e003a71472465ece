#include "core/field/field_image.h"

#include <algorithm>

#include "core/base/vote_kernels.h"

namespace lpf {

FieldImage::FieldImage(const Pattern& pattern) : pattern_(pattern) {
    const std::size_t places =
        pattern.grid_size() > 0 ? pattern.raster().size() : std::size_t(pattern.padded_size());
    values_.resize(3 * places);
}

void FieldImage::assign(const float* field) {
    if (pattern_.grid_size() == 0) {
        std::copy_n(field, values_.size(), values_.begin());
        return;
    }
    float* to = values_.data();
    for (int c = 0; c < 3; ++c) {
        for (const int node : pattern_.raster()) *to++ = field[c * pattern_.padded_size() + node];
    }
}

void FieldImage::read(const float* x, const float* y, std::size_t n, float* const out[3]) const {
    if (pattern_.grid_size() == 0) {
        read_by_stencils(x, y, n, out);
        return;
    }
    const int half = pattern_.grid_size() / 2;
    const float scale = 1.0F / pattern_.step();
    const auto offset = static_cast<float>(half);
    kernels::read_image({.values = values_.data(),
                         .columns = 2 * half + 1,
                         .rows = 2 * half + 1,
                         .scale_x = scale,
                         .offset_x = offset,
                         .scale_y = scale,
                         .offset_y = offset},
                        3, x, y, n, out);
}

void FieldImage::read_by_stencils(const float* x, const float* y, std::size_t n,
                                  float* const out[3]) const {
    for (std::size_t i = 0; i < n; ++i) {
        const Pattern::Stencil stencil = pattern_.stencil(x[i], y[i]);
        for (int c = 0; c < 3; ++c) {
            const float* channel = values_.data() + c * pattern_.padded_size();
            out[c][i] = 0;
            for (int k = 0; k < 4; ++k) out[c][i] += stencil.weight[k] * channel[stencil.node[k]];
        }
    }
}

}  // namespace lpf
