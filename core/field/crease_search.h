#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Where a parabola leaves much of the shape, or meets an edge of it, two faces may meet: tries a
/// surface with a crease, and takes it if it explains the points better.
/// @param sigmas      members lie within so many sigma of a surface
/// @param meets_edge  whether the piece is known to do so
/// @param piece       grown and measured in `sample`; left so, too
void fold_at_crease(PieceSample& sample, float sigmas, bool meets_edge, Piece& piece);

}  // namespace lpf
