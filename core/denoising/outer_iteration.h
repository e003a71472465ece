#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/denoise.h"
#include "core/denoising/votes.h"
#include "core/shape/box.h"

namespace lpf {

/// Gets how far points go. @param order indices of the points  @param moves of each [radius]
using TakeMoves = std::function<void(const std::vector<std::uint32_t>& order, const Moves& moves)>;

/// One outer iteration of denoising (paper Sec. 4.2): LPFs on the points as they are now, their
/// joint analysis, and their consensus.
/// @param params of this iteration
/// @param region where moves are wanted; what points further off do is of no use
[[nodiscard]] AnalysisResult find_moves(const Shape& current, const DenoiseParams& params,
                                        const Region& region, const Execution& execution,
                                        const TakeMoves& take);

/// Eq. 12, with q the current position: the full step, or the share gamma / (1 + gamma) of it.
/// @returns what a move is multiplied with [input length / radius]
[[nodiscard]] double step_length(const DenoiseParams& params);

/// Whether the first outer iteration ends with a deconvolution: where the noise is known and the
/// same everywhere, and the full step is taken.
[[nodiscard]] bool is_deconvolved(const DenoiseParams& params);

/// Whether another outer iteration is worth it after those that moved the points so far.
/// @param bent share of the points that was deconvolved
[[nodiscard]] bool goes_on(const DenoiseParams& params, const std::vector<double>& rms_moves,
                           double bent);

/// Of an outer iteration: all but the deconvolution.
inline constexpr double kShareOfMoves = 0.85;

/// The part of the work that outer iteration i is. Those that may not be worth it are a small one.
[[nodiscard]] Execution part_of_iteration(const Execution& execution, const DenoiseParams& params,
                                          std::size_t i);

/// Parameters of the next outer iteration: it starts from the dictionary of the one before, and
/// there is less noise.
void prepare_next(Dictionary dictionary, DenoiseParams& params);

}  // namespace lpf
