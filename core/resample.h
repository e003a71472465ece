#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/analysis.h"
#include "core/denoise.h"

namespace lpf {

/// Parameters of resampling (paper Sec. 4.1). Exactly one of the two targets is positive.
struct ResampleParams {
    AnalysisParams analysis = {};
    double target_spacing = 0.0;    ///< tau_p, least distance of two points [input length]
    std::size_t target_points = 0;  ///< number of points wanted, met within 2 % where it can be

    /// Distance over which the shape goes on between input points: a candidate without a point that
    /// near it is beyond a border and dropped [input length]; 0 = keep all (meshes).
    double support = 0.0;

    /// Share of what the codes leave out of the fields that is put back, 0 to 1: 0 consolidates
    /// (noisy points), 1 follows the probed shape exactly (meshes, which have no noise to leave
    /// out).
    double detail = 0.0;

    /// Noisy points are denoised before they are resampled.
    std::optional<DenoiseParams> denoise = {};
};

struct ResampleResult {
    Points points;
    std::vector<std::uint32_t> source;  ///< nearest input point of each, as an index into the input
    std::vector<std::uint32_t> field;   ///< the LPF that proposed it
    double spacing = 0.0;               ///< no two points are nearer; tau_p if given [input length]
    AnalysisResult analysis;
};

/// Points from the consensus of all decoded LPFs (Sec. 4.1, Eq. 7 and 8): no two nearer than tau_p.
/// @throws as analyze
[[nodiscard]] ResampleResult resample(const Shape& shape, const ResampleParams& params,
                                      const Execution& execution);

}  // namespace lpf
