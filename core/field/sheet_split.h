#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Two sides of a plate that is hardly thicker than the noise look like one surface whose points
/// scatter too much, and not as noise does. Takes such a surface for two sheets about the mean of
/// both.
/// @param sigmas  members lie within so many sigma of a sheet
/// @param piece   grown and measured in `sample`
void split_sheets(PieceSample& sample, float sigmas, Piece& piece);

}  // namespace lpf
