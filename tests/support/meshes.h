#pragma once

#include "core/shape/shape.h"

namespace lpf::test {

/// The surface of [-half, half]^3, each face a lattice of `cells` x `cells` squares, two triangles
/// each, turned outwards. Vertices of neighbouring faces are shared.
[[nodiscard]] Shape cube_mesh(double half = 1.0, int cells = 1);

/// An icosahedron, each triangle split in four `subdivisions` times, vertices on the sphere.
[[nodiscard]] Shape icosphere(double radius = 1.0, int subdivisions = 3);

/// A sphere by latitude and longitude: two poles and `rings` circles of `segments` vertices each.
[[nodiscard]] Shape globe(double radius, int rings, int segments);

/// [-half, half]^2 at z = 0: `cells` x `cells` squares, two triangles each, normals up.
[[nodiscard]] Shape plane_grid(double half = 1.0, int cells = 10);

/// The four sides of a square pyramid of base 80 and height 54.3, open below, with horizontal
/// engravings .5 to 2.5 wide: V-shaped, with flat floors, and courses of stone. Vertices 0 to 3 are
/// the corners of the base, in order.
[[nodiscard]] Shape pyramid_mesh();

/// A sector of a turned disk with steps, a groove, a fillet and sharp rims, in the manner of the
/// Fandisk model; closed, diagonal 7.6.
[[nodiscard]] Shape disk_segment_mesh();

/// A head without a name: round, with a face in low waves and rows of locks over the rest; closed,
/// diagonal 52, vertices about .25 apart.
[[nodiscard]] Shape head_mesh();

/// The edges of a mesh at which the normals of its two triangles differ by more than `degrees`, as
/// triangles without area (a, b, b) over the vertices of the mesh.
[[nodiscard]] Triangles sharp_edges(const Shape& mesh, double degrees = 30.0);

/// The edges of one triangle only, written the same way.
[[nodiscard]] Triangles border_edges(const Shape& mesh);

}  // namespace lpf::test
