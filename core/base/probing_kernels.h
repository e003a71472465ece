#pragma once

#include <cstddef>

/// The loops over the nodes of a pattern that look for what the shape has near them.
namespace lpf::kernels {

/// out[i] = sum over k in [-reach, reach] of taps[k] in[i + k stride], for i in [0, n).
/// @param taps points at the middle of 2 reach + 1 values
void convolve(const float* in, float* out, std::size_t n, int stride, const float* taps, int reach);

/// Which of the points is nearest to each of 16 nodes at (first_x + k step, row_y), k < 16.
/// @param squared, point out: squared distance, infinite where there are no points, and whose it
/// is; of equally near ones the first
void nearest_to_nodes(const float* x, const float* y, std::size_t n, float first_x, float step,
                      float row_y, float squared[16], int point[16]);

/// Which of the points is nearest to a place: of equally near ones the first, n if there is none.
/// @param n a multiple of 16; points at infinity fill up
std::size_t nearest_to_place(const float* x, const float* y, std::size_t n, float at_x,
                             float at_y);

}  // namespace lpf::kernels
