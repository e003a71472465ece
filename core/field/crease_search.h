#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Where a parabola leaves much of the shape, or cuts an edge off it, two faces may meet: tries a
/// surface with a crease, and takes it if it explains the points better.
/// @param sigmas      members lie within so many sigma of a surface
/// @param is_chamfer  whether the piece is known to cut an edge off
/// @param piece       grown and measured in `sample`; left so, too
void fold_at_crease(PieceSample& sample, float sigmas, bool is_chamfer, Piece& piece);

}  // namespace lpf
