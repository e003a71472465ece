#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// A rod about as thick as the noise looks like a curve, or like a strip of a surface. Makes a tube
/// of it, if it is one: the curve of its axis, and a radius.
/// @param sigmas  members lie within so many sigma of the tube
/// @param piece   a curve, grown and measured in `sample`; left so, too
void widen_to_tube(PieceSample& sample, float sigmas, Piece& piece);

}  // namespace lpf
