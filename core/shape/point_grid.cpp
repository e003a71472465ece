#include "core/shape/point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/kernels.h"
#include "core/base/radix_sort.h"
#include "core/shape/extent.h"

namespace lpf {
namespace {

/// Cells along an axis at most: three axes must fit one 63-bit key.
constexpr double kMaximumCells = 1 << 20;

/// Of a squared radius, so that no rounding loses a cell that the ball only touches.
constexpr double kRoundingUp = 1 + 1e-6;

constexpr Eigen::Index kSampleOfCells = 1 << 12;
constexpr int kMostHalvings = 20;

/// How many of the other keys equal a key, on average.
double mean_equals(std::vector<std::uint64_t>& keys) {
    std::ranges::sort(keys);
    double pairs = 0;
    for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
        while (end < keys.size() && keys[end] == keys[begin]) ++end;
        const auto equal = static_cast<double>(end - begin);
        pairs += equal * (equal - 1);
    }
    return pairs / static_cast<double>(keys.size());
}

/// The first item whose coordinate is `wanted` or more. Coordinates rise, and mostly by one: then
/// the first guess is right.
template <typename Iterator, typename Member>
Iterator first_from(Iterator begin, Iterator end, std::uint64_t wanted, Member coordinate) {
    if (begin == end || (*begin).*coordinate >= wanted) return begin;
    const std::uint64_t steps = wanted - (*begin).*coordinate;
    if (steps < static_cast<std::uint64_t>(end - begin)) {
        const Iterator guess = begin + static_cast<std::ptrdiff_t>(steps);
        if ((*guess).*coordinate == wanted) return guess;
        end = guess;
    }
    return std::lower_bound(begin, end, wanted, [&](const auto& item, std::uint64_t w) {
        return item.*coordinate < w;
    });
}

}  // namespace

double cell_of_some_points(const Points& points, double most, const Execution& execution) {
    const Eigen::Index stride = 1 + (points.cols() - 1) / kSampleOfCells;
    const Eigen::AlignedBox3d box = bounding_box(points, execution);
    double cell = box.sizes().maxCoeff();
    for (int i = 0; i < kMostHalvings && cell > 0; ++i, cell /= 2) {
        std::vector<std::uint64_t> keys;
        for (Eigen::Index k = 0; k < points.cols(); k += stride) {
            const Eigen::Vector3d at = (points.col(k) - box.min()) / cell;
            const auto axis = [&](int a) { return static_cast<std::uint64_t>(at[a]); };
            keys.push_back((axis(2) << 42U) | (axis(1) << 21U) | axis(0));
        }
        if (mean_equals(keys) * static_cast<double>(stride) <= most) break;
    }
    return cell;
}

void NearPoints::reserve(std::size_t points) {
    if (x.size() >= points) return;
    const std::size_t room = std::max(points, 2 * x.size());
    x.resize(room);
    y.resize(room);
    z.resize(room);
    index.resize(room);
}

void NearPoints::append(const NearPoints& others, std::size_t first, std::size_t count) {
    reserve(size + count);
    std::copy_n(others.x.data() + first, count, x.data() + size);
    std::copy_n(others.y.data() + first, count, y.data() + size);
    std::copy_n(others.z.data() + first, count, z.data() + size);
    std::copy_n(others.index.data() + first, count, index.data() + size);
    size += count;
}

PointGrid::PointGrid(const Points& points, double cell, const Execution& execution) {
    if (points.cols() == 0) {
        slabs_ = {{0, 0}};
        rows_ = {{0, 0}};
        cells_ = {{0, 0}};
        return;
    }
    const Eigen::AlignedBox3d box = bounding_box(points, execution);
    origin_ = box.min();
    const Eigen::Vector3d extent = box.sizes();
    cell = std::max(cell, extent.maxCoeff() / kMaximumCells);
    inverse_cell_ = 1.0 / cell;
    for (int axis = 0; axis < 3; ++axis) {
        size_[axis] = static_cast<std::uint64_t>(extent[axis] * inverse_cell_) + 1;
    }
    if (size_[0] * size_[1] * size_[2] <= std::numeric_limits<std::uint32_t>::max()) {
        sort_points<std::uint32_t>(points, execution);
    } else {
        sort_points<std::uint64_t>(points, execution);
    }
}

std::uint64_t PointGrid::key_of(const Eigen::Vector3d& relative) const {
    std::uint64_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
        cell[axis] =
            std::min(static_cast<std::uint64_t>(relative[axis] * inverse_cell_), size_[axis] - 1);
    }
    return (cell[2] * size_[1] + cell[1]) * size_[0] + cell[0];
}

template <typename Key>
void PointGrid::sort_points(const Points& points, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<Keyed<Key>> items(n);
    parallel_for(
        execution, n, kPointsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end; ++i) {
                items[i] = {
                    static_cast<Key>(key_of(points.col(static_cast<Eigen::Index>(i)) - origin_)),
                    static_cast<std::uint32_t>(i)};
            }
        });
    {
        std::vector<Keyed<Key>> room;
        radix_sort(items, room, size_[0] * size_[1] * size_[2], execution);
    }
    order_.resize(n);
    for (Eigen::VectorXd* axis : {&x_, &y_, &z_}) axis->resize(points.cols());
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         order_[i] = items[i].second;
                         const Eigen::Vector3d relative = points.col(items[i].second) - origin_;
                         const auto at = static_cast<Eigen::Index>(i);
                         x_[at] = relative.x();
                         y_[at] = relative.y();
                         z_[at] = relative.z();
                     }
                 });
    index_cells(items, execution);
}

template <typename Key>
void PointGrid::index_cells(const std::vector<Keyed<Key>>& sorted, const Execution& execution) {
    std::vector<std::vector<std::uint32_t>> starts(chunk_count(sorted.size(), kPointsPerChunk));
    parallel_for(execution, sorted.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     for (std::size_t i = begin; i < end; ++i) {
                         if (i > 0 && sorted[i].first == sorted[i - 1].first) continue;
                         starts[chunk].push_back(static_cast<std::uint32_t>(i));
                     }
                 });
    std::uint64_t last_row = ~std::uint64_t{0};
    for (const std::vector<std::uint32_t>& chunk : starts) {
        for (const std::uint32_t first_point : chunk) {
            const std::uint64_t key = sorted[first_point].first;
            const std::uint64_t row = key / size_[0];
            if (row != last_row) {
                const auto z = static_cast<std::uint32_t>(row / size_[1]);
                if (slabs_.empty() || slabs_.back().z != z) {
                    slabs_.push_back({z, static_cast<std::uint32_t>(rows_.size())});
                }
                rows_.push_back({static_cast<std::uint32_t>(row % size_[1]),
                                 static_cast<std::uint32_t>(cells_.size())});
            }
            cells_.push_back({static_cast<std::uint32_t>(key % size_[0]), first_point});
            last_row = row;
        }
    }
    slabs_.push_back({~0U, static_cast<std::uint32_t>(rows_.size())});
    rows_.push_back({~0U, static_cast<std::uint32_t>(cells_.size())});
    cells_.push_back({~0U, static_cast<std::uint32_t>(order_.size())});
}

std::vector<std::uint32_t> PointGrid::places(const Execution& execution) const {
    std::vector<std::uint32_t> places(order_.size());
    parallel_for(execution, places.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         places[order_[i]] = static_cast<std::uint32_t>(i);
                     }
                 });
    return places;
}

void PointGrid::gather(const Eigen::Vector3d& centre, double unit, float reach,
                       NearPoints& near) const {
    near.size = 0;
    const Eigen::Vector3d relative = centre - origin_;
    const Eigen::Vector3d place = inverse_cell_ * relative;  // [cells]
    const double ball = kRoundingUp * inverse_cell_ * unit * static_cast<double>(reach);
    std::uint64_t low[3];
    std::uint64_t high[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double last = static_cast<double>(size_[axis] - 1);
        const double first_cell = std::floor(place[axis] - ball);
        const double last_cell = std::floor(place[axis] + ball);
        if (last_cell < 0 || first_cell > last) return;
        low[axis] = static_cast<std::uint64_t>(std::max(first_cell, 0.0));
        high[axis] = static_cast<std::uint64_t>(std::min(last_cell, last));
    }
    const double scale = 1.0 / unit;
    const auto gather_run = [&](std::size_t begin, std::size_t end) {
        near.reserve(near.size + end - begin + kernels::kGatherSlack);
        const std::size_t at = near.size;
        near.size += kernels::gather_ball(x_.data() + begin, y_.data() + begin, z_.data() + begin,
                                          end - begin, relative.data(), scale, reach, begin,
                                          &near.x[at], &near.y[at], &near.z[at], &near.index[at]);
    };
    // How far the ball reaches past the cells of a row: what it leaves of them along x.
    const auto beyond = [&](int axis, std::uint64_t cell) {
        const double below = static_cast<double>(cell) - place[axis];
        const double outside = std::max({below, -below - 1, 0.0});
        return outside * outside;
    };
    const auto slabs_end = slabs_.end() - 1;
    auto slab = first_from(slabs_.begin(), slabs_end, low[2], &Slab::z);
    for (; slab != slabs_end && slab->z <= high[2]; ++slab) {
        const double left_by_z = ball * ball - beyond(2, slab->z);
        if (left_by_z < 0) continue;
        const auto rows_end = rows_.begin() + (slab + 1)->first_row;
        auto row = first_from(rows_.begin() + slab->first_row, rows_end, low[1], &Row::y);
        for (; row != rows_end && row->y <= high[1]; ++row) {
            const double left = left_by_z - beyond(1, row->y);
            if (left < 0) continue;
            const double half = std::sqrt(left);
            const double first_cell = place[0] - half;
            const double last_cell = place[0] + half;
            if (last_cell < 0) continue;
            const auto first = static_cast<std::uint64_t>(std::max(first_cell, 0.0));
            const auto last = static_cast<std::uint64_t>(last_cell);
            const auto cells_end = cells_.begin() + (row + 1)->first_cell;
            const auto cell =
                first_from(cells_.begin() + row->first_cell, cells_end, first, &Cell::x);
            auto end = cell;
            while (end != cells_end && end->x <= last) ++end;
            if (cell != end) gather_run(cell->first_point, end->first_point);
        }
    }
}

}  // namespace lpf
