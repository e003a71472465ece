#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// For each of some points the nearest one of a cloud; any of those equally near.
/// @param cloud of one point at least  @param points near the cloud, or few of them far off
/// @returns indices into the cloud
[[nodiscard]] std::vector<std::uint32_t> nearest_sources(const Points& cloud, const Points& points,
                                                         const Execution& execution);

}  // namespace lpf
