#include "core/field/target_area.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/kernels.h"

namespace lpf {
namespace {

/// Cells along an axis at most: three axes must fit one 63-bit key, and the slabs need a table.
constexpr double kMaximumCells = 1 << 20;

/// Points between two questions whether to stop.
constexpr std::size_t kPointsPerQuestion = 1U << 18U;

using Keyed = std::pair<std::uint64_t, std::uint32_t>;

/// Stable radix sort by key, 11 bits a pass, only as many passes as the largest key needs.
void sort_by_key(std::vector<Keyed>& items, std::uint64_t largest_key, const Execution& execution) {
    constexpr unsigned kBits = 11;
    constexpr std::uint64_t kMask = (1U << kBits) - 1;
    std::vector<Keyed> sorted(items.size());
    for (unsigned shift = 0; shift < 64 && (largest_key >> shift) != 0; shift += kBits) {
        throw_if_cancelled(execution);
        std::array<std::uint32_t, kMask + 1> start{};
        for (const Keyed& item : items) ++start[(item.first >> shift) & kMask];
        std::uint32_t total = 0;
        for (std::uint32_t& count : start) total += std::exchange(count, total);
        for (const Keyed& item : items) sorted[start[(item.first >> shift) & kMask]++] = item;
        items.swap(sorted);
    }
}

}  // namespace

void TargetArea::reserve(std::size_t points) {
    if (x.size() >= points) return;
    const std::size_t room = std::max(points, 2 * x.size());
    x.resize(room);
    y.resize(room);
    z.resize(room);
    index.resize(room);
}

void TargetArea::to_frame(const Frame& frame) {
    Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes = frame.axes;
    kernels::to_frame(axes.data(), frame.origin.data(), x.data(), y.data(), z.data(), size);
}

PointGrid::PointGrid(const Points& points, double cell, const Execution& execution) {
    if (points.cols() == 0) {
        slab_first_row_ = {0, 0};
        rows_ = {{0, 0}};
        cells_ = {{0, 0}};
        return;
    }
    origin_ = points.rowwise().minCoeff();
    const Eigen::Vector3d extent = points.rowwise().maxCoeff() - origin_;
    cell = std::max(cell, extent.maxCoeff() / kMaximumCells);
    inverse_cell_ = 1.0 / cell;
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = static_cast<std::uint64_t>(extent[axis] * inverse_cell_) + 1;
    }
    sort_points(points, execution);
    throw_if_cancelled(execution);
    index_cells();
}

std::uint64_t PointGrid::key_of(const Eigen::Vector3d& relative) const {
    std::uint64_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] =
            std::min(static_cast<std::uint64_t>(relative[axis] * inverse_cell_), size_[axis] - 1);
    }
    return (cell[2] * size_[1] + cell[1]) * size_[0] + cell[0];
}

void PointGrid::sort_points(const Points& points, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<Keyed> items(n);
    for (std::size_t i = 0; i < n; ++i) {
        if (i % kPointsPerQuestion == 0) throw_if_cancelled(execution);
        items[i] = {key_of(points.col(static_cast<Eigen::Index>(i)) - origin_),
                    static_cast<std::uint32_t>(i)};
    }
    sort_by_key(items, size_[0] * size_[1] * size_[2], execution);

    order_.resize(n);
    x_.resize(n);
    y_.resize(n);
    z_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        if (i % kPointsPerQuestion == 0) throw_if_cancelled(execution);
        order_[i] = items[i].second;
        const Eigen::Vector3d relative = points.col(items[i].second) - origin_;
        x_[i] = relative.x();
        y_[i] = relative.y();
        z_[i] = relative.z();
    }
}

void PointGrid::index_cells() {
    slab_first_row_.assign(size_[2] + 1, 0);
    std::uint64_t last_key = ~std::uint64_t{0};
    std::uint64_t last_row = ~std::uint64_t{0};
    for (std::size_t i = 0; i < order_.size(); ++i) {
        const std::uint64_t key = key_of({x_[i], y_[i], z_[i]});
        if (key == last_key) continue;
        const std::uint64_t row = key / size_[0];
        if (row != last_row) {
            rows_.push_back({static_cast<std::uint32_t>(row % size_[1]),
                             static_cast<std::uint32_t>(cells_.size())});
            ++slab_first_row_[row / size_[1] + 1];
        }
        cells_.push_back(
            {static_cast<std::uint32_t>(key % size_[0]), static_cast<std::uint32_t>(i)});
        last_key = key;
        last_row = row;
    }
    for (std::size_t z = 0; z < size_[2]; ++z) slab_first_row_[z + 1] += slab_first_row_[z];
    rows_.push_back({~0U, static_cast<std::uint32_t>(cells_.size())});
    cells_.push_back({~0U, static_cast<std::uint32_t>(order_.size())});
}

void PointGrid::gather(const Frame& frame, float reach, TargetArea& target) const {
    target.size = 0;
    const Eigen::Vector3d centre = frame.centre - origin_;
    const double ball = frame.radius * static_cast<double>(reach);
    std::uint64_t low[3];
    std::uint64_t high[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(size_[axis] - 1);
        const double first_cell = std::floor((centre[axis] - ball) * inverse_cell_);
        const double last_cell = std::floor((centre[axis] + ball) * inverse_cell_);
        if (last_cell < 0 || first_cell > last) return;
        low[axis] = static_cast<std::uint64_t>(std::max(first_cell, 0.0));
        high[axis] = static_cast<std::uint64_t>(std::min(last_cell, last));
    }
    const double scale = 1.0 / frame.radius;
    const auto gather_run = [&](std::size_t begin, std::size_t end) {
        target.reserve(target.size + end - begin);
        const std::size_t at = target.size;
        target.size += kernels::gather_ball(&x_[begin], &y_[begin], &z_[begin], end - begin,
                                            centre.data(), scale, reach, begin, &target.x[at],
                                            &target.y[at], &target.z[at], &target.index[at]);
    };
    for (std::uint64_t z = low[2]; z <= high[2]; ++z) {
        auto row = rows_.begin() + slab_first_row_[z];
        const auto rows_end = rows_.begin() + slab_first_row_[z + 1];
        row = std::lower_bound(row, rows_end, low[1],
                               [](const Row& a, std::uint64_t y) { return a.y < y; });
        for (; row != rows_end && row->y <= high[1]; ++row) {
            const auto cells_end = cells_.begin() + (row + 1)->first_cell;
            const auto cell =
                std::lower_bound(cells_.begin() + row->first_cell, cells_end, low[0],
                                 [](const Cell& a, std::uint64_t x) { return a.x < x; });
            auto last = cell;
            while (last != cells_end && last->x <= high[0]) ++last;
            if (cell != last) gather_run(cell->first_point, last->first_point);
        }
    }
}

}  // namespace lpf
