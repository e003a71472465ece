#pragma once

#include <cstddef>

/// The loops over the points of a target area that creased surfaces are fitted with. Structure of
/// arrays of n floats each, in units of the LPF's radius.
namespace lpf::kernels {

/// z = c . (1, x, y, xx, xy, yy) + slope times the distance to the line normal . (x, y) = at,
/// blurred by noise.
struct CreasedSurface {
    const float* c;
    float slope;
    float normal_x, normal_y, at;
    float noise;
};

/// out[i] = (z[i] - surface(x[i], y[i]))^2.
void offsets_from_crease(const CreasedSurface& surface, const float* x, const float* y,
                         const float* z, std::size_t n, float* out);

/// z[i] -= surface(x[i], y[i]).
void subtract_crease(const CreasedSurface& surface, const float* x, const float* y, std::size_t n,
                     float* z);

/// Lines normal . (x, y) = at.
struct Lines {
    const float *normal_x, *normal_y, *at;
    std::size_t count;  ///< a multiple of 16
};

/// For each line, sums over n places of weight times the distance d to it: of d, d x, d y, d d, d
/// z.
/// @param out 5 x lines.count, row-major
void line_sums(const Lines& lines, const float* x, const float* y, const float* z,
               const float* weight, std::size_t n, float* out);

/// The rows of a Gauss-Newton step on a creased surface.
inline constexpr int kCreaseRows = 10;

/// Sums of the products of 1, x, y, xx, xy, yy, blurred distance, its derivative by a shift of the
/// line and by a turn of it, and z, over every stride-th of the points with off[i] <= limit.
/// @param out kCreaseRows x kCreaseRows, row-major, the lower half
void crease_moments(const CreasedSurface& surface, const float* x, const float* y, const float* z,
                    const float* off, float limit, std::size_t n, std::size_t stride, double* out);

}  // namespace lpf::kernels
