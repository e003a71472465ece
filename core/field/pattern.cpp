#include "core/field/pattern.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "core/base/error.h"
#include "core/base/random.h"

namespace lpf {
namespace {

constexpr int kMinimumGrid = 4;
constexpr int kMaximumGrid = 128;
constexpr int kMaximumPoints = 12849;  // M of the largest grid
constexpr int kMinimumPoints = 5;

/// Calls visit(i, j) for every node of an n x n grid inside the open disk, row by row.
template <typename Visit>
void for_each_grid_node(int n, Visit visit) {
    const int half = n / 2;
    for (int j = -half; j <= half; ++j) {
        for (int i = -half; i <= half; ++i) {
            if (4 * (i * i + j * j) < n * n) visit(i, j);
        }
    }
}

int grid_points(int n) {
    int count = 0;
    for_each_grid_node(n, [&](int, int) { ++count; });
    return count;
}

}  // namespace

Pattern Pattern::grid(int n) {
    if (n < kMinimumGrid || n > kMaximumGrid) {
        throw Error(ErrorCode::InvalidParameter,
                    "The pattern grid has " + std::to_string(n) + " nodes a side; it takes " +
                        std::to_string(kMinimumGrid) + " to " + std::to_string(kMaximumGrid) + ".",
                    "patternPoints");
    }
    Eigen::Matrix3Xf offsets(3, grid_points(n));
    const float step = 2.0F / static_cast<float>(n);
    Eigen::Index column = 0;
    for_each_grid_node(n, [&](int i, int j) {
        offsets.col(column++) << step * static_cast<float>(i), step * static_cast<float>(j), 0.0F;
    });
    return {offsets, n, step};
}

Pattern Pattern::random_disk(int points, std::uint64_t random_seed) {
    if (points < kMinimumPoints || points > kMaximumPoints) {
        throw Error(ErrorCode::InvalidParameter,
                    "A pattern takes " + std::to_string(kMinimumPoints) + " to " +
                        std::to_string(kMaximumPoints) + " points, not " + std::to_string(points) +
                        ".",
                    "patternPoints");
    }
    Random random(random_seed, 0x9a77e24);
    Eigen::Matrix3Xf offsets = Eigen::Matrix3Xf::Zero(3, points);
    for (Eigen::Index i = 1; i < points; ++i) {
        const double radius = std::sqrt(random.uniform());
        const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
        offsets(0, i) = static_cast<float>(radius * std::cos(angle));
        offsets(1, i) = static_cast<float>(radius * std::sin(angle));
    }
    return from_points(offsets);
}

Pattern Pattern::from_points(const Eigen::Matrix3Xf& offsets) {
    if (offsets.cols() < kMinimumPoints || offsets.cols() > kMaximumPoints) {
        throw Error(ErrorCode::InvalidParameter,
                    "A pattern takes " + std::to_string(kMinimumPoints) + " to " +
                        std::to_string(kMaximumPoints) + " points, not " +
                        std::to_string(offsets.cols()) + ".",
                    "patternPoints");
    }
    // A point drawn on the rim may lie a rounding error outside it.
    constexpr float kRim = 1.0F + 1e-5F;
    for (Eigen::Index i = 0; i < offsets.cols(); ++i) {
        if (!offsets.col(i).allFinite() || offsets.col(i).head<2>().norm() > kRim) {
            throw Error(ErrorCode::InvalidParameter,
                        "Pattern point " + std::to_string(i) +
                            " is not inside the unit disk; offsets are in units of the radius.",
                        "patternPoints");
        }
    }
    const float step = std::sqrt(std::numbers::pi_v<float> / static_cast<float>(offsets.cols()));
    return {offsets, 0, step};
}

int Pattern::grid_size_for(int points) {
    int best = kMinimumGrid;
    for (int n = kMinimumGrid; n <= kMaximumGrid; ++n) {
        if (std::abs(grid_points(n) - points) < std::abs(grid_points(best) - points)) best = n;
    }
    return best;
}

Pattern::Pattern(const Eigen::Matrix3Xf& offsets, int grid_size, float step)
    : size_(static_cast<int>(offsets.cols())),
      padded_(static_cast<int>(whole_lines(static_cast<std::size_t>(size_)))),
      grid_size_(grid_size),
      step_(step),
      data_(3 * static_cast<std::size_t>(padded_), 0.0F) {
    for (int i = 0; i < size_; ++i) {
        for (int c = 0; c < 3; ++c) {
            data_[static_cast<std::size_t>(c * padded_ + i)] = offsets(c, i);
        }
    }
    index_nodes();
}

Eigen::Vector3f Pattern::point(int i) const {
    return {channel(0)[i], channel(1)[i], channel(2)[i]};
}

/// Fills the raster that finds the nodes around a place: on a grid one node a cell, which is the
/// node itself or the nearest inside the disk; otherwise the four nearest nodes of the cell's
/// centre.
void Pattern::index_nodes() {
    by_distance_.resize(static_cast<std::size_t>(size_));
    std::iota(by_distance_.begin(), by_distance_.end(), 0);
    const auto squared = [this](int i, float x, float y) {
        const float dx = channel(0)[i] - x;
        const float dy = channel(1)[i] - y;
        return dx * dx + dy * dy;
    };
    std::stable_sort(by_distance_.begin(), by_distance_.end(),
                     [&](int a, int b) { return squared(a, 0, 0) < squared(b, 0, 0); });

    raster_size_ =
        grid_size_ > 0 ? grid_size_ / 2 * 2 + 1 : std::clamp(static_cast<int>(2 / step_), 8, 64);
    const int per_cell = grid_size_ > 0 ? 1 : 4;
    const float cell = grid_size_ > 0 ? step_ : 2.0F / static_cast<float>(raster_size_);
    const float first =
        -cell * static_cast<float>(raster_size_ / 2) + (raster_size_ % 2 == 0 ? cell / 2 : 0.0F);
    std::vector<int> nearest(by_distance_);
    int node = 0;  // of a grid: its nodes run row by row, as the raster does
    for (int row = 0; row < raster_size_; ++row) {
        for (int column = 0; column < raster_size_; ++column) {
            const float x = first + cell * static_cast<float>(column);
            const float y = first + cell * static_cast<float>(row);
            if (grid_size_ > 0 && node < size_ && squared(node, x, y) < cell * cell / 16) {
                raster_.push_back(node++);
                continue;
            }
            std::partial_sort(nearest.begin(), nearest.begin() + per_cell, nearest.end(),
                              [&](int a, int b) {
                                  const float da = squared(a, x, y);
                                  const float db = squared(b, x, y);
                                  return da < db || (da == db && a < b);
                              });
            raster_.insert(raster_.end(), nearest.begin(), nearest.begin() + per_cell);
        }
    }
}

Pattern::Stencil Pattern::stencil(float x, float y) const {
    Stencil result{};
    const float limit = static_cast<float>(raster_size_ - 1);
    if (grid_size_ > 0) {
        const float half = static_cast<float>(grid_size_ / 2);
        const float column = std::clamp(x / step_ + half, 0.0F, limit);
        const float row = std::clamp(y / step_ + half, 0.0F, limit);
        const int i = std::min(static_cast<int>(column), raster_size_ - 2);
        const int j = std::min(static_cast<int>(row), raster_size_ - 2);
        const float a = column - static_cast<float>(i);
        const float b = row - static_cast<float>(j);
        const int* at = raster_.data() + j * raster_size_ + i;
        return {{at[0], at[1], at[raster_size_], at[raster_size_ + 1]},
                {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b}};
    }
    const float scale = static_cast<float>(raster_size_) / 2;
    const int i = static_cast<int>(std::clamp((x + 1) * scale, 0.0F, limit));
    const int j = static_cast<int>(std::clamp((y + 1) * scale, 0.0F, limit));
    const int* at = raster_.data() + 4 * (j * raster_size_ + i);
    float total = 0;
    for (int k = 0; k < 4; ++k) {
        const float dx = channel(0)[at[k]] - x;
        const float dy = channel(1)[at[k]] - y;
        result.node[k] = at[k];
        result.weight[k] = 1.0F / (dx * dx + dy * dy + 1e-6F);
        total += result.weight[k];
    }
    for (float& weight : result.weight) weight /= total;
    return result;
}

}  // namespace lpf
