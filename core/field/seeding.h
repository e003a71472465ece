#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/field/frame.h"
#include "core/field/target_area.h"

namespace lpf {

/// How seeds are spread over a shape.
struct SeedingParams {
    double radius = 0.0;         ///< r of the LPFs [input length]
    double spacing = 0.5;        ///< least distance of two seeds [radius]; 0 = every point
    double target_radius = 1.1;  ///< of the target areas [radius]
    /// Spread off the mean plane that noise explains [input length]. Where the target area spreads
    /// further, and further than any edge does, it holds more than one side of the shape: seeds get
    /// smaller radii there. 0 = one radius for all.
    double noise_spread = 0.0;
    std::uint64_t random_seed = 1;
};

/// Frames at the seeds (paper Sec. 3.1), axes not yet set, in the order of the grid: their target
/// areas cover all points. Departs from the paper, which has one radius for a shape.
/// @param grid over `points`
[[nodiscard]] std::vector<Frame> place_seeds(const Points& points, const PointGrid& grid,
                                             const SeedingParams& params,
                                             const Execution& execution);

}  // namespace lpf
