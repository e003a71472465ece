#include "core/field/field_image.h"

#include <algorithm>

#include "core/base/vote_kernels.h"

namespace lpf {
namespace {

/// The displacement, and one that fills up.
constexpr std::size_t kValuesOfPlace = 4;

}  // namespace

FieldImage::FieldImage(const Pattern& pattern) : pattern_(pattern) {
    values_.resize(pattern.grid_size() > 0 ? kValuesOfPlace * pattern.raster().size()
                                           : 3 * std::size_t(pattern.padded_size()));
}

void FieldImage::assign(const float* field) {
    if (pattern_.grid_size() == 0) {
        std::copy_n(field, values_.size(), values_.begin());
        return;
    }
    float* to = values_.data();
    for (const int node : pattern_.raster()) {
        for (int c = 0; c < 3; ++c) to[c] = field[c * pattern_.padded_size() + node];
        to += kValuesOfPlace;
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
    kernels::read_three({.values = values_.data(),
                         .columns = 2 * half + 1,
                         .rows = 2 * half + 1,
                         .scale_x = scale,
                         .offset_x = offset,
                         .scale_y = scale,
                         .offset_y = offset},
                        x, y, n, out);
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
