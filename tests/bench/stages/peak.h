#pragma once

#include <cstddef>

namespace lpf::bench {

/// A plain loop of fused multiply-adds in registers, compiled for what the machine has.
/// @returns something that depends on all of them
float multiply_and_add(std::size_t rounds, float factor, float summand);

/// Floating-point operations of a round.
inline constexpr double kOperationsOfRound = 2.0 * 16 * 12;

/// Operations per second that the loop reaches on this core, measured once.
[[nodiscard]] double peak_rate();

}  // namespace lpf::bench
