#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/auto_parameters.h"

namespace lpf::server {

/// What one of the three processes has made of a shape.
struct Computation {
    std::optional<Points> points;       ///< none for an analysis
    std::vector<std::uint32_t> source;  ///< of a resampling: nearest input point of each point
    std::vector<double> rms_moves;      ///< of a denoising
    AnalysisResult analysis;

    /// The points are those of the input, moved: as many, in the same order.
    [[nodiscard]] bool keeps_vertices() const { return source.empty(); }
};

[[nodiscard]] Computation compute(Task task, const Shape& shape,
                                  const ResolvedParameters& parameters, const Execution& execution);

}  // namespace lpf::server
