#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/field/frame.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// The points of the shape that one LPF accounts for (paper Sec. 3.1): structure of arrays,
/// float32, in units of the LPF's radius. Reused from LPF to LPF, so that the inner loops allocate
/// nothing.
struct TargetArea {
    std::vector<float> x, y, z;        ///< `size` values in use
    std::vector<std::uint32_t> index;  ///< of each point in the PointGrid's order
    std::size_t size = 0;

    void reserve(std::size_t points);

    /// From centre-relative coordinates to those of the frame.
    void to_frame(const Frame& frame);
};

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

    /// Position of the i-th sorted point [input length].
    [[nodiscard]] Eigen::Vector3d point(std::size_t i) const {
        return origin_ + Eigen::Vector3d(x_[i], y_[i], z_[i]);
    }

    /// All points within `reach` radii of the frame's centre, relative to the centre and in units
    /// of the frame's radius, in a fixed order.
    void gather(const Frame& frame, float reach, TargetArea& target) const;

private:
    struct Row {
        std::uint32_t y;           // cell coordinate
        std::uint32_t first_cell;  // into cells_
    };
    struct Cell {
        std::uint32_t x;            // cell coordinate
        std::uint32_t first_point;  // into the sorted arrays
    };

    void sort_points(const Points& points, const Execution& execution);
    void index_cells();
    [[nodiscard]] std::uint64_t key_of(const Eigen::Vector3d& relative) const;

    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
    double inverse_cell_ = 1.0;
    std::uint64_t size_[3] = {1, 1, 1};  // cells along each axis
    std::vector<std::uint32_t> order_;
    std::vector<double> x_, y_, z_;              // relative to origin_
    std::vector<std::uint32_t> slab_first_row_;  // size_[2] + 1, into rows_
    std::vector<Row> rows_;                      // one more than there are
    std::vector<Cell> cells_;                    // one more than there are
};

}  // namespace lpf
