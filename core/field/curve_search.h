#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Where curves cross, their points fill a plane and a piece takes them for a surface, or a curve
/// ends in the crossing. Follows the curve through the centre instead, if there is one.
/// @param sigmas  members lie within so many sigma of a curve
/// @param piece   grown and measured in `sample`; left so, too
void follow_crossing_curve(PieceSample& sample, float sigmas, Piece& piece);

}  // namespace lpf
