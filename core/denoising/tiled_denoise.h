#pragma once

#include <vector>

#include "core/denoise.h"
#include "core/shape/point_source.h"

namespace lpf {

/// So many tiles are worked on at a time, however many threads there are: each takes memory.
inline constexpr int kTilesAtOnce = 4;

/// How a large cloud is cut.
struct TilingParams {
    std::size_t points = 1'000'000;   ///< in a tile, without those around it; about
    std::size_t patches = 64;         ///< that the dictionary is learned on
    std::size_t patch_points = 8192;  ///< in each, about
    bool count_duplicates = false;    ///< as the points of a tile are at hand
};

struct TiledDenoising {
    std::vector<Eigen::Vector3f> moves;  ///< of each point [input length]; 0 where it is not finite
    std::vector<double> rms_moves;       ///< RMS move to the consensus, of each iteration
    /// Of the last outer iteration, tile by tile. Energies are means over the LPFs of all tiles,
    /// so that those near borders count more than once.
    AnalysisResult analysis;
    std::size_t duplicates = 0;  ///< points on the place of an earlier one, if they were counted
};

/// As `denoise`, for clouds of which a copy is too much: one dictionary is learned on patches all
/// over the cloud; then each tile, with all around it that LPFs of its points can see, is denoised
/// against it. Results do not depend on how many tiles are worked on at a time; memory does.
/// Points that are not finite stay as they are.
/// @throws Error{InvalidParameter, IncompatibleDictionary, TooFewPoints, DegenerateShape,
/// Cancelled}
[[nodiscard]] TiledDenoising denoise_tiles(const PointSource& source, const DenoiseParams& params,
                                           const Execution& execution,
                                           const TilingParams& tiling = {});

}  // namespace lpf
