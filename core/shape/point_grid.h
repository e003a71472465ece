#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// Points around a centre: structure of arrays, float32, relative to the centre and in a unit of
/// the caller's. Reused from search to search, so that inner loops allocate nothing.
struct NearPoints {
    std::vector<float> x, y, z;        ///< `size` values in use
    std::vector<std::uint32_t> index;  ///< of each point in the PointGrid's order
    std::size_t size = 0;

    void reserve(std::size_t points);

    /// Adds `count` points of others, from number `first` on.
    void append(const NearPoints& others, std::size_t first, std::size_t count);
};

/// The side of the largest cells in which a point has no more than `most` others with it on average
/// (within a factor of two: sides are halved until it is so). Estimated from a sample.
[[nodiscard]] double cell_of_some_points(const Points& points, double most,
                                         const Execution& execution);

/// The cloud sorted into cubic cells, for gathering balls of points about as large as a cell.
/// Points of a row of cells lie one behind the other. Any extent is fine: only cells with points
/// exist.
class PointGrid {
public:
    /// @param cell side of the cells [input length], > 0
    PointGrid(const Points& points, double cell, const Execution& execution = {});

    [[nodiscard]] std::size_t size() const { return order_.size(); }

    /// order()[i] = input index of the i-th sorted point.
    [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }

    /// places()[i] = where input point i is in that order.
    [[nodiscard]] std::vector<std::uint32_t> places(const Execution& execution = {}) const;

    /// Position of the i-th sorted point [input length].
    [[nodiscard]] Eigen::Vector3d point(std::size_t i) const {
        const auto at = static_cast<Eigen::Index>(i);
        return origin_ + Eigen::Vector3d(x_[at], y_[at], z_[at]);
    }

    /// All points within `reach` units of the centre, in ascending order of their index.
    /// @param unit of the results [input length]
    void gather(const Eigen::Vector3d& centre, double unit, float reach, NearPoints& near) const;

private:
    struct Slab {
        std::uint32_t z;          // cell coordinate
        std::uint32_t first_row;  // into rows_
    };
    struct Row {
        std::uint32_t y;           // cell coordinate
        std::uint32_t first_cell;  // into cells_
    };
    struct Cell {
        std::uint32_t x;            // cell coordinate
        std::uint32_t first_point;  // into the sorted arrays
    };

    template <typename Key>
    void sort_points(const Points& points, const Execution& execution);
    template <typename Key>
    void index_cells(const std::vector<std::pair<Key, std::uint32_t>>& sorted,
                     const Execution& execution);
    [[nodiscard]] std::uint64_t key_of(const Eigen::Vector3d& relative) const;

    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
    double inverse_cell_ = 1.0;
    std::uint64_t size_[3] = {1, 1, 1};  // cells along each axis
    std::vector<std::uint32_t> order_;
    Eigen::VectorXd x_, y_, z_;  // relative to origin_; not zeroed first
    std::vector<Slab> slabs_;    // one more than there are
    std::vector<Row> rows_;      // one more than there are
    std::vector<Cell> cells_;    // one more than there are
};

}  // namespace lpf
