#pragma once

#include "core/shape/shape.h"

namespace lpf::test {

/// The surface of [-half, half]^3, each face a lattice of `cells` x `cells` squares, two triangles
/// each, turned outwards. Vertices of neighbouring faces are shared.
[[nodiscard]] Shape cube_mesh(double half = 1.0, int cells = 1);

/// An icosahedron, each triangle split in four `subdivisions` times, vertices on the sphere.
[[nodiscard]] Shape icosphere(double radius = 1.0, int subdivisions = 3);

/// [-half, half]^2 at z = 0: `cells` x `cells` squares, two triangles each, normals up.
[[nodiscard]] Shape plane_grid(double half = 1.0, int cells = 10);

}  // namespace lpf::test
