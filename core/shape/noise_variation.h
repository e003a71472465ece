#pragma once

#include <optional>

#include "core/shape/noise_map.h"
#include "core/shape/noise_reading.h"

namespace lpf {

/// Noise that is not the same everywhere.
struct NoiseVariation {
    double usual = 0.0;  ///< mean over the points [input length]
    NoiseMap map;        ///< relative to it
};

/// Where noise is looked for. Lengths in the input's unit.
struct NoiseSearch {
    double lowest = 0.0;   ///< noise that there is, where there is least
    double radius = 0.0;   ///< of balls that it fits into
    double largest = 0.0;  ///< that they may grow to, where there is more
    double least = 0.0;    ///< less than this is none to speak of
};

/// Whether noise varies over a cloud, and how; nothing where it hardly does.
[[nodiscard]] std::optional<NoiseVariation> find_noise_variation(const SampledCloud& cloud,
                                                                 const PointGrid& grid,
                                                                 const NoiseSearch& search,
                                                                 const Execution& execution);

}  // namespace lpf
