#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_grid.h"
#include "core/shape/shape.h"

namespace lpf {

/// Poisson-disk subset of the points: no two nearer than `spacing`, and every point within
/// `spacing` of a chosen one (paper Sec. 3.1). spacing = 0 chooses every point.
/// @returns indices of the chosen points, ascending
[[nodiscard]] std::vector<std::uint32_t> poisson_disk_subset(const Points& points, double spacing,
                                                             std::uint64_t random_seed,
                                                             const Execution& execution);

/// The same among some points of a grid. @param places of the points in the order of the grid
/// @returns which of the places are chosen, ascending
[[nodiscard]] std::vector<std::uint32_t> poisson_disk_subset(const PointGrid& grid,
                                                             std::span<const std::uint32_t> places,
                                                             double spacing,
                                                             std::uint64_t random_seed,
                                                             const Execution& execution);

/// Points on the triangles, uniform by area, about `per_area` of them per unit area (at least one a
/// mesh); degenerate triangles get none.
/// @returns 3 x K
[[nodiscard]] Points sample_triangles(const Points& vertices, const Triangles& triangles,
                                      double per_area, std::uint64_t random_seed);

}  // namespace lpf
