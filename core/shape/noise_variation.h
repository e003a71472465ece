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

/// What noise is looked for. Lengths in the input's unit.
struct NoiseSearch {
    double lowest = 0.0;        ///< that there is where there is least
    double least = 0.0;         ///< less than this is none to speak of
    double largest_ball = 0.0;  ///< that it may need
};

/// Whether noise varies over a cloud, and how; nothing where it hardly does.
/// @param readings all over the cloud, in balls that the lowest noise fits into
[[nodiscard]] std::optional<NoiseVariation> find_noise_variation(
    const std::vector<NoiseReading>& readings, const SampledCloud& cloud, const PointGrid& grid,
    const NoiseSearch& search, const Execution& execution);

}  // namespace lpf
