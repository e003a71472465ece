#pragma once

#include <cstddef>

/// The innermost loops over plain float arrays, compiled for several instruction sets and chosen at
/// run time. No type with a layout that depends on compiler flags may cross this header.
namespace lpf::kernels {

/// Sum of a[i] b[i].
float dot(const float* a, const float* b, std::size_t n);

/// Sum of (a[i] - b[i])^2.
float squared_distance(const float* a, const float* b, std::size_t n);

/// Columns of a panel. A matrix in panels is so many columns of all its rows, row by row, then the
/// next so many: what a product reads one after the other lies side by side. The last panel is as
/// wide as there are columns left.
inline constexpr std::size_t kPanel = 32;

/// out = a matrix of rows x n values, row-major, in panels.
void to_panels(const float* values, std::size_t rows, std::size_t n, float* out);

/// out = left right, for count x inner values, row-major, and inner x n in panels.
/// @param n a multiple of 16
void multiply(const float* left, std::size_t count, std::size_t inner, const float* right,
              std::size_t n, float* out);

/// out += left right, for count x inner and inner x n values, row-major.
void add_product(const float* left, std::size_t count, std::size_t inner, const float* right,
                 std::size_t n, float* out);

/// out[i] += scale * in[i].
void add_scaled(float scale, const float* in, float* out, std::size_t n);

/// out = sum of coefficient[i] times row[i], i < count; rows by their numbers, `stride` floats from
/// one to the next, of which n are combined.
void combine_rows(const float* rows, std::size_t stride, std::size_t n, const unsigned* row,
                  const float* coefficient, std::size_t count, float* out);

/// Raw moments of two point sets a = u + v and b = u + w, each three channels of n floats.
struct PairMoments {
    float a[3];   ///< sum a
    float b[3];   ///< sum b
    float ab[9];  ///< sum a b', row-major
};
PairMoments pair_moments(const float* u, const float* v, const float* w, std::size_t n);

/// Moves the points p = u + v by R p + t, in place of v; all three channels of n floats.
void move_points(const float* rotation, const float* translation, const float* u, std::size_t n,
                 float* v);

/// (x, y, z) <- axes' ((x, y, z) - origin), in place; axes row-major 3 x 3 (columns t1, t2, n).
void to_frame(const float* axes, const float* origin, float* x, float* y, float* z, std::size_t n);

/// Sums of x, y, z, xx, xy, xz, yy, yz, zz.
void second_moments(const float* x, const float* y, const float* z, std::size_t n, float out[9]);

/// What a parabola z = c . (1, x, y, xx, xy, yy) is fitted from, over the points with
/// off[i] <= limit: sums of x^a y^b with a + b <= 4, ordered by a + b, then by b; then of z times
/// 1, x, y, xx, xy, yy.
void parabola_moments(const float* x, const float* y, const float* z, const float* off, float limit,
                      std::size_t n, float out[21]);

/// out[i] = (z[i] - c . (1, x, y, xx, xy, yy))^2.
void offsets_from_parabola(const float c[6], const float* x, const float* y, const float* z,
                           std::size_t n, float* out);

/// z[i] -= c . (1, x, y, xx, xy, yy).
void subtract_parabola(const float c[6], const float* x, const float* y, std::size_t n, float* z);

/// out[i] = squared distance of (y, z) to the cubics c[0..3] and c[4..7] of x, over (1, x, xx,
/// xxx).
void offsets_from_cubics(const float c[8], const float* x, const float* y, const float* z,
                         std::size_t n, float* out);

/// Numbers of the blocks of a raster over [-extent, extent]^2 that points lie in, row by row; those
/// beyond it belong to the outermost. @param side number of blocks along an axis
void block_numbers(const float* x, const float* y, float extent, int side, std::size_t n,
                   unsigned* out);

inline constexpr std::size_t kGatherSlack = 16;

/// Appends to the outputs the points of a run that lie within `limit` of the centre.
/// dx = float((x[i] - centre[0]) * scale) and so on; kept when dx^2 + dy^2 + dz^2 <= limit^2.
/// @param first index of the first point of the run  @returns how many were appended
/// The outputs need room for n + kGatherSlack more values each.
std::size_t gather_ball(const double* x, const double* y, const double* z, std::size_t n,
                        const double centre[3], double scale, float limit, std::size_t first,
                        float* out_x, float* out_y, float* out_z, unsigned* out_index);

}  // namespace lpf::kernels
