#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/parallel.h"
#include "core/shape/shape.h"

namespace lpf {

/// The smallest box that holds all points; empty where there are none. Points that are not finite
/// make no difference or give any box.
[[nodiscard]] Eigen::AlignedBox3d bounding_box(const Points& points,
                                               const Execution& execution = {});

/// The middle of that box; the origin where there are no points. Halves are added, so that it is
/// finite wherever the points are.
[[nodiscard]] Eigen::Vector3d centre_of(const Points& points, const Execution& execution = {});

/// Some of the points, in the order of their numbers.
[[nodiscard]] Points selected(const Points& points, std::span<const std::uint32_t> numbers,
                              const Execution& execution = {});

/// Whether no coordinate is infinite or not a number.
[[nodiscard]] bool all_finite(const Points& points, const Execution& execution = {});

/// What every shape needs to be worked on: at least 3 points, not all in one place.
/// @throws Error{TooFewPoints}
void check_number_of_points(std::size_t points);

/// @param extent of the points, in any measure [input length]  @throws Error{DegenerateShape}
void check_extent(double extent);

}  // namespace lpf
