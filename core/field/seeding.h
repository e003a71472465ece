#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/field/frame.h"
#include "core/field/piece.h"
#include "core/field/target_area.h"
#include "core/shape/box.h"
#include "core/shape/noise_map.h"

namespace lpf {

/// How seeds are spread over a shape.
struct SeedingParams {
    double radius = 0.0;         ///< r of the LPFs [input length]
    double spacing = 0.5;        ///< least distance of two seeds [radius]; 0 = every point
    double target_radius = 1.1;  ///< of the target areas [radius]
    /// Standard deviation of the points off the shape [input length]; 0 = unknown: an LPF is about
    /// all that its target area holds.
    double noise = 0.0;
    NoiseMap noise_map = {};    ///< where there is more of it, and less
    bool adapt_radius = false;  ///< LPFs as large as the shape around them allows
    double least_radius = 0.0;  ///< of those that adapt [input length]
    std::uint64_t random_seed = 1;
    Region region = {};  ///< LPFs are only placed where their target areas reach into it
};

/// LPFs that are placed but have no pose yet.
struct Seeds {
    std::vector<Frame> frames;
    std::vector<Piece> pieces;  ///< what each is about; without noise, of no dimension
};

/// Seeds (paper Sec. 3.1), in the order of the grid: every point is in the piece of an LPF near it.
/// Departs from the paper, which has one radius for a shape, and takes all points within it.
/// @param grid over `points`
[[nodiscard]] Seeds place_seeds(const Points& points, const PointGrid& grid,
                                const SeedingParams& params, const Execution& execution);

}  // namespace lpf
