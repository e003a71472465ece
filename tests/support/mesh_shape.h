#pragma once

#include "core/shape/shape.h"
#include "tests/support/shapes.h"

namespace lpf::test {

/// A shape that is known by a triangle mesh: its surface, its borders (edges of one triangle) and
/// its sharp edges (whose two triangles turn by more than `sharp_degrees`); sampled by area.
/// @pre the triangles share their vertices and are turned the same way; one at least has an area
TestShape make_mesh_shape(const Shape& mesh, const Sampling& sampling, double sharp_degrees = 30.0);

}  // namespace lpf::test
