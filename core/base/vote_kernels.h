#pragma once

#include <cstddef>
#include <cstdint>

/// The loops over the points of one target area that votes are made of. Structure of arrays of n
/// floats each, in units of the LPF's radius.
namespace lpf::kernels {

/// rows x columns places, at each of them one value or four together. (x, y) lies at column
/// x scale_x + offset_x and row y scale_y + offset_y, at most at the rim.
/// @pre at least two rows and columns
struct Image {
    const float* values;
    int columns;
    int rows;
    float scale_x, offset_x;
    float scale_y, offset_y;
};

/// out[i] = the value at (x[i], y[i]), bilinearly, of an image of one value at each place.
void read_image(const Image& image, const float* x, const float* y, std::size_t n, float* out);

/// The same for the first three values of an image of four.
void read_three(const Image& image, const float* x, const float* y, std::size_t n,
                float* const out[3]);

/// Adds weights to the values at the four places about each point, as reading shares them out, of
/// an image of four values.
/// @param weight four arrays of n
/// @param values of the image
void add_to_four(const Image& image, const float* x, const float* y, const float* const weight[4],
                 std::size_t n, float* values);

/// out[i] += sign (p(x + dx, y + dy) - p(x, y)), where p = c . (1, x, y, xx, xy, yy).
void add_parabola_change(const float c[6], float sign, const float* x, const float* y,
                         const float* dx, const float* dy, std::size_t n, float* out);

/// out[i] += sign (p(x + dx) - p(x)), where p = c . (1, x, xx, xxx).
void add_cubic_change(const float c[4], float sign, const float* x, const float* dx, std::size_t n,
                      float* out);

/// (x, y, z) <- axes (x, y, z), in place; axes row-major 3 x 3.
void rotate(const float axes[9], float* x, float* y, float* z, std::size_t n);

/// What a vote for the move m = (mx, my, mz) of the point (x, y) counts. Its likelihood is
/// Student's t-distribution of seven degrees of freedom, (1 + m^2 precision / 8)^-4: up to the
/// width that of a normal distribution, but points that noise has moved far are not held back by
/// whichever LPF moves them least.
struct Weighing {
    float reliability;  ///< of the LPF
    bool fades;         ///< towards the rim of the disk, as (1 - r^2)^2; outside it counts nothing
    float least_density;  ///< densities are cut to [least_density, 1]
    float precision;      ///< of the likely moves, 1 / width^2; 0: all are likely
};

/// weight[i]: a density in, the weight of the vote out.
void weigh(const Weighing& how, const float* x, const float* y, const float* mx, const float* my,
           const float* mz, std::size_t n, float* weight);

/// Adds votes in fixed point: sums[4 p .. 4 p + 3] += scale weight (1, mx, my, mz), p = point[i].
/// Votes of weight 0 add nothing; others count within the limits.
void add_votes(const unsigned* point, const float* weight, const float* mx, const float* my,
               const float* mz, std::size_t n, float scale, float least, float largest,
               std::int64_t* sums);

}  // namespace lpf::kernels
