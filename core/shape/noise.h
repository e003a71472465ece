#pragma once

#include <cstddef>

#include "core/base/parallel.h"
#include "core/shape/noise_map.h"
#include "core/shape/point_source.h"

namespace lpf {

/// What the automatic parameters are made from.
struct Measurements {
    std::size_t points = 0;
    double diagonal = 0.0;      ///< of the bounding box [input length]
    double mean_spacing = 0.0;  ///< mean distance to the nearest other position [input length]
    double noise = 0.0;         ///< sigma, standard deviation off the local surface [input length]
    NoiseMap noise_map = {};    ///< where there is more noise, and less; `noise` is the mean
    double density_radius = 0.0;  ///< radius whose ball holds about 150 points [input length]
};

/// Measures a cloud on a sample of its points. Duplicates do not count as neighbours.
/// @throws Error{TooFewPoints} below 3 points, Error{DegenerateShape} if all coincide
[[nodiscard]] Measurements measure(const Points& points, const Execution& execution);

/// The same for a cloud that need not be in memory, on some parts of it. Points that are not finite
/// do not count.
[[nodiscard]] Measurements measure(const PointSource& source, const Execution& execution);

}  // namespace lpf
