#pragma once

#include <cstddef>
#include <vector>

#include "core/shape/point_cloud.h"

namespace lpf {

/// The coordinates of all points as float32, point by point: x y z x y z ...
[[nodiscard]] std::vector<float> float_positions(const Points& points);

/// The largest distance, along an axis, between a coordinate and its float32.
[[nodiscard]] double rounding_of(const Points& points);

/// True if a coordinate is beyond the range of float32.
[[nodiscard]] bool exceed_float32(const Points& points);

}  // namespace lpf
