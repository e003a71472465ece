#pragma once

#include <cstddef>

namespace lpf {

/// What every shape needs to be worked on: at least 3 points, not all in one place.
/// @throws Error{TooFewPoints}
void check_number_of_points(std::size_t points);

/// @param extent of the points, in any measure [input length]  @throws Error{DegenerateShape}
void check_extent(double extent);

}  // namespace lpf
