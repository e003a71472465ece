#include "core/field/piece_sample.h"

#include <algorithm>
#include <utility>

#include "core/base/crease_kernels.h"
#include "core/base/kernels.h"

namespace lpf {
namespace {

/// A ball that is not smaller than the outermost by this ratio is left out.
constexpr float kLeastStep = 1.2F;

}  // namespace

void PieceSample::assign(const TargetArea& target, std::size_t most, float first, float growth,
                         float extent) {
    const std::size_t stride = std::max<std::size_t>(1, (target.size + most - 1) / most);
    const std::size_t count = (target.size + stride - 1) / stride;
    stride_ = static_cast<float>(stride);
    extent_ = extent;

    ball_radius_.clear();
    for (float radius = first; radius * kLeastStep < extent; radius *= growth) {
        ball_radius_.push_back(radius);
    }
    ball_radius_.push_back(extent);

    // A counting sort by rings keeps the order within each.
    squared_offset.resize(count);
    for (std::vector<float>* values : {&px, &py, &pz, &squared_distance, &x, &y, &z}) {
        values->resize(count);
    }
    for (std::size_t i = 0, k = 0; i < target.size; i += stride, ++k) {
        squared_offset[k] =
            target.x[i] * target.x[i] + target.y[i] * target.y[i] + target.z[i] * target.z[i];
    }
    ring_.assign(count, 0);
    for (std::size_t ring = 0; ring + 1 < ball_radius_.size(); ++ring) {
        const float limit = ball_radius_[ring] * ball_radius_[ring];
        for (std::size_t k = 0; k < count; ++k) {
            ring_[k] += static_cast<std::uint32_t>(squared_offset[k] > limit);
        }
    }
    ball_end_.assign(ball_radius_.size(), 0);
    for (std::size_t k = 0; k < count; ++k) ++ball_end_[ring_[k]];
    std::size_t before = 0;
    for (std::size_t& end : ball_end_) before += std::exchange(end, before);
    for (std::size_t i = 0, k = 0; i < target.size; i += stride, ++k) {
        const std::size_t at = ball_end_[ring_[k]]++;
        px[at] = target.x[i];
        py[at] = target.y[i];
        pz[at] = target.z[i];
        squared_distance[at] = squared_offset[k];
    }
}

void PieceSample::look_along(const Piece& piece, std::size_t count) {
    std::copy_n(px.begin(), count, x.begin());
    std::copy_n(py.begin(), count, y.begin());
    std::copy_n(pz.begin(), count, z.begin());
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes = piece.axes;
    kernels::to_frame(axes.data(), piece.origin.data(), x.data(), y.data(), z.data(), count);
}

void PieceSample::measure(const Piece& piece, std::size_t count) {
    float* out = squared_offset.data();
    if (piece.is_curve() && piece.sheets[0] == 0) {
        kernels::offsets_from_cubics(piece.coefficients, x.data(), y.data(), z.data(), count, out);
    } else if (piece.sheets[0] == 0 && piece.crease.slope == 0) {
        kernels::offsets_from_parabola(piece.coefficients, x.data(), y.data(), z.data(), count,
                                       out);
    } else if (piece.sheets[0] == 0) {
        kernels::offsets_from_crease(creased_surface(piece), x.data(), y.data(), z.data(), count,
                                     out);
    } else {
        for (std::size_t i = 0; i < count; ++i) out[i] = piece.squared_offset(x[i], y[i], z[i]);
    }
}

std::size_t PieceSample::count_within(float distance) const {
    std::size_t points = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        points += static_cast<std::size_t>(squared_offset[i] <= distance * distance);
    }
    return points;
}

}  // namespace lpf
