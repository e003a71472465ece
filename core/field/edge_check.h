#pragma once

#include "core/field/piece_sample.h"

namespace lpf {

/// Whether a smooth surface runs up to an edge of the shape, or cuts it off as a chamfer does:
/// points go on just off it where its members end. A wire above a wall is no edge of it, nor is a
/// second sheet.
/// @param sample measured against the piece
[[nodiscard]] bool meets_edge(const PieceSample& sample, const Piece& piece);

}  // namespace lpf
