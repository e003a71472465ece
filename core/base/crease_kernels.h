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

/// Sums of weight times the distance d to the line normal . (x, y) = at: of d, d x, d y, d d, d z.
void line_sums(float normal_x, float normal_y, float at, const float* x, const float* y,
               const float* z, const float* weight, std::size_t n, float out[5]);

/// The rows of a Gauss-Newton step on a creased surface.
inline constexpr int kCreaseRows = 10;

/// Sums of the products of 1, x, y, xx, xy, yy, blurred distance, its derivative by a shift of the
/// line and by a turn of it, and z, over every stride-th of the points with off[i] <= limit.
/// @param out kCreaseRows x kCreaseRows, row-major, the lower half
void crease_moments(const CreasedSurface& surface, const float* x, const float* y, const float* z,
                    const float* off, float limit, std::size_t n, std::size_t stride, double* out);

}  // namespace lpf::kernels
