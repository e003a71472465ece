#pragma once

#include <cstddef>

/// The loops over the nodes of a pattern that look for what the shape has near them.
namespace lpf::kernels {

/// out[i] = sum over k in [-reach, reach] of taps[k] in[i + k stride], for i in [0, n).
/// @param taps points at the middle of 2 reach + 1 values
void convolve(const float* in, float* out, std::size_t n, int stride, const float* taps, int reach);

/// Displacements of 16 nodes at (first_x + k step, row_y, 0) to the points nearest in the plane, of
/// equally near ones the first.
/// @param y is read by whole registers, up to 15 values behind the last
/// @param nodes how many of these are nodes  @param out x, y and z of the displacements of all 16,
/// `stride` floats from one channel to the next
/// @returns the largest squared distance of a node in the plane; infinite where there are no points
float nearest_to_nodes(const float* x, const float* y, const float* z, std::size_t n, float first_x,
                       float step, float row_y, int nodes, float* out, std::size_t stride);

/// Adds (1, x, y, z) of each point to the cell it lies in, of a raster of cells that are `step`
/// wide, the middle one about 0; points beyond the raster count in its outermost cells.
/// @param side number of cells along x, odd  @param rows the same along y, or 1: y makes no
/// difference
/// @param cells 4 values for each of side x rows cells
void add_to_cells(const float* x, const float* y, const float* z, std::size_t n, float step,
                  int side, int rows, float* cells);

/// Which of the points is nearest to a place: of equally near ones the first, n if there is none.
/// @param n a multiple of 16; points at infinity fill up
std::size_t nearest_to_place(const float* x, const float* y, std::size_t n, float at_x, float at_y);

}  // namespace lpf::kernels
