#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <tuple>

namespace lpf {

using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

/// Cells in an order in which neighbours are near: row by row.
struct CellsByRows {
    bool operator()(const Cell& a, const Cell& b) const {
        return std::tuple(a.z(), a.y(), a.x()) < std::tuple(b.z(), b.y(), b.x());
    }
};

/// Calls visit(cell) for a cell and the 26 around it.
template <typename Visit>
void for_each_neighbour(const Cell& cell, const Visit& visit) {
    for (int i = 0; i < 27; ++i) visit(cell + Cell(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
}

/// The cells from `low` to below `high` along each axis.
struct CellBox {
    Cell low;
    Cell high;

    [[nodiscard]] bool holds(const Cell& cell) const {
        return (cell.array() >= low.array()).all() && (cell.array() < high.array()).all();
    }
};

/// Cubic cells laid over all space. Coordinates too far off for their number are in the last one.
struct CellLattice {
    Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< of the cell (0, 0, 0) [input length]
    double side = 1.0;                                 ///< of a cell [input length], > 0

    static constexpr std::int64_t kLast = std::int64_t{1} << 50U;

    [[nodiscard]] Cell cell_of(const Eigen::Vector3d& point) const {
        constexpr auto kEnd = static_cast<double>(kLast);
        return ((point - corner) / side).array().floor().max(-kEnd).min(kEnd).cast<std::int64_t>();
    }

    /// Where the cells lie [input length].
    [[nodiscard]] Eigen::AlignedBox3d space_of(const CellBox& cells) const {
        return {corner + side * cells.low.cast<double>(),
                corner + side * cells.high.cast<double>()};
    }

    /// All cells.
    static CellBox everything() { return {Cell::Constant(-kLast), Cell::Constant(kLast + 1)}; }
};

/// A box that reaches further by `margin` on all sides [input length].
[[nodiscard]] inline Eigen::AlignedBox3d widened(const Eigen::AlignedBox3d& box, double margin) {
    return {box.min().array() - margin, box.max().array() + margin};
}

}  // namespace lpf
