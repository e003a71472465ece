#pragma once

#include <vector>

#include "core/analysis.h"

namespace lpf {

/// Share of the noise that is left after denoising, at most.
inline constexpr double kNoiseLeft = 0.25;

/// Parameters of denoising (paper Sec. 4.2).
struct DenoiseParams {
    AnalysisParams analysis = {};
    int iterations = 2;       ///< outer iterations at most, 1 to 50
    double gamma = 0.0;       ///< Eq. 12: q <- (q + gamma q~)/(1 + gamma); 0 = the full step
    bool sharp = false;       ///< vote for sharp edges: uniform weights, error power 3
    double stop_ratio = 0.1;  ///< stop when the RMS move falls under this share of the first
    bool slides = true;       ///< points beyond a border or an end are pulled to it
    double least_bent = 0.0;  ///< stop when less than this share of the points was deconvolved
};

struct DenoiseResult {
    Points points;                  ///< as many as the input, in its order
    std::vector<double> rms_moves;  ///< RMS move to the consensus, of each iteration [input length]
    AnalysisResult analysis;        ///< of the last outer iteration
};

/// @throws Error{InvalidParameter} naming the field that is out of range
void validate(const DenoiseParams& params);

/// A shape of more points is worked on tile by tile (core/denoising/tiled_denoise.h).
inline constexpr std::size_t kMostAtOnce = 4'000'000;

/// Moves every point to the consensus of the LPFs around it. Points that no LPF covers stay.
/// @throws as analyze
[[nodiscard]] DenoiseResult denoise(const Shape& shape, const DenoiseParams& params,
                                    const Execution& execution);

}  // namespace lpf
