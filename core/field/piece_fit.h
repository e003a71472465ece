#pragma once

#include <cstddef>

#include "core/field/piece_sample.h"

namespace lpf {

/// Fits the coefficients of a smooth piece to those of the first `count` points that are members of
/// it, by least squares. Keeps them where the points do not determine any.
void fit_smooth(const PieceSample& sample, std::size_t count, Piece& piece);

/// Estimates the piece's errors from all its members: what its model leaves of the shape shows in
/// the means of blocks of them, noise in what varies within blocks.
/// @returns the number of members
std::size_t estimate_error(const PieceSample& sample, Piece& piece);

}  // namespace lpf
