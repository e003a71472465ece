#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/radix_sort.h"
#include "core/shape/point_grid.h"

namespace lpf {

/// Some places of a grid, grouped into cubic cells of eight colours. Between two cells of one
/// colour lies at least one of another: threads may work on both at once, as long as they look no
/// further than half a side around their cell.
class ColouredCells {
public:
    static constexpr std::size_t kColours = 8;

    struct Cell {
        std::uint32_t key;    ///< tells cells apart
        std::uint32_t begin;  ///< of its members
        std::uint32_t end;
    };

    /// @param places of the points in the order of the grid, at least one
    /// @param side   of the cells at least [input length], > 0; larger where there would be very
    /// many
    ColouredCells(const PointGrid& grid, std::span<const std::uint32_t> places, double side,
                  const Execution& execution);

    [[nodiscard]] const std::vector<Cell>& of_colour(std::size_t colour) const {
        return cells_[colour];
    }

    /// The i-th member of all cells: its position among the places. Those of one cell ascend.
    [[nodiscard]] std::uint32_t member(std::size_t i) const { return members_[i].second; }

private:
    using Coordinates = Eigen::Array<std::uint32_t, 3, 1>;

    static Coordinates cell_of(const Eigen::Vector3d& low, const Eigen::Vector3d& at, double side);
    void find_cells(std::uint32_t of_one_colour);

    std::vector<Keyed<std::uint32_t>> members_;  // by the keys of their cells
    std::vector<Cell> cells_[kColours];
};

}  // namespace lpf
