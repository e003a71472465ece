#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// Marks isolated points: 1 where the mean distance to the 8 nearest other points is above the
/// median of all by more than `deviations` robust standard deviations (1.4826 MAD of the logarithm,
/// so that slow changes of density do not count).
/// @returns one flag per point
[[nodiscard]] std::vector<std::uint8_t> find_outliers(const Points& points, double deviations,
                                                      const Execution& execution);

/// Marks every point that repeats the exact position of an earlier one.
[[nodiscard]] std::vector<std::uint8_t> find_duplicates(const Points& points,
                                                        const Execution& execution = {});

}  // namespace lpf
