#include "core/shape/coloured_cells.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace lpf {
namespace {

/// No more cells along an axis, so that keys have 32 bits.
constexpr double kMostCells = 1024;

}  // namespace

ColouredCells::ColouredCells(const PointGrid& grid, std::span<const std::uint32_t> places,
                             double side, const Execution& execution)
    : members_(places.size()) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t place : places) box.extend(grid.point(place));
    side = std::max(side, box.sizes().maxCoeff() / kMostCells);
    const Coordinates halves = cell_of(box.min(), box.max(), side) / 2 + 1;
    const std::uint32_t of_one_colour = halves.prod();
    parallel_for(execution, places.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         const Coordinates at = cell_of(box.min(), grid.point(places[i]), side);
                         const Coordinates half = at / 2;
                         const Coordinates odd = at - 2 * half;
                         const std::uint32_t colour = odd[0] + 2 * odd[1] + 4 * odd[2];
                         const std::uint32_t row = half[2] * halves[1] + half[1];
                         members_[i] = {colour * of_one_colour + row * halves[0] + half[0],
                                        static_cast<std::uint32_t>(i)};
                     }
                 });
    std::vector<Keyed<std::uint32_t>> room;
    radix_sort(members_, room, kColours * of_one_colour, execution);
    find_cells(of_one_colour);
}

ColouredCells::Coordinates ColouredCells::cell_of(const Eigen::Vector3d& low,
                                                  const Eigen::Vector3d& at, double side) {
    return ((at - low) / side).array().cast<std::uint32_t>();
}

void ColouredCells::find_cells(std::uint32_t of_one_colour) {
    const auto count = static_cast<std::uint32_t>(members_.size());
    for (std::uint32_t begin = 0, end = 0; begin < count; begin = end) {
        const std::uint32_t key = members_[begin].first;
        while (end < count && members_[end].first == key) ++end;
        cells_[key / of_one_colour].push_back({key, begin, end});
    }
}

}  // namespace lpf
