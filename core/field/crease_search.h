#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Where a parabola leaves much of the shape, two faces may meet in an edge: tries a surface with a
/// crease, and takes it if it explains the points better.
/// @param sigmas  members lie within so many sigma of a surface
/// @param piece   grown and measured in `sample`; left so, too
void fold_at_crease(PieceSample& sample, float sigmas, Piece& piece);

}  // namespace lpf
