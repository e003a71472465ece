#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Whether a surface cuts an edge or a corner off the shape, as a chamfer does, rather than lie
/// along it: points go on just off it where its members end. A wire above a wall does not make the
/// wall a chamfer, nor does a second sheet.
/// @param sample measured against the piece
[[nodiscard]] bool is_chamfer(const PieceSample& sample, const Piece& piece);

}  // namespace lpf
