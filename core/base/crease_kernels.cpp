#include "core/base/crease_kernels.h"

#include <algorithm>
#include <cmath>

#include "core/base/blur.h"
#include "core/base/multiversion.h"
#include "core/base/polynomial.h"

namespace lpf::kernels {
namespace {

constexpr std::size_t kBlock = 256;

using Rows = float[kCreaseRows][kBlock];

/// The rows at a block of points; zero where a point is no member, and behind the last.
LPF_MULTIVERSION
void fill_rows(const CreasedSurface& s, const float* x, const float* y, const float* z,
               const float* off, float limit, std::size_t size, Rows& rows) {
#pragma omp simd
    for (std::size_t i = 0; i < size; ++i) {
        const float member = off[i] <= limit ? 1.0F : 0.0F;
        const float px = x[i];
        const float py = y[i];
        const float along = s.normal_x * py - s.normal_y * px;
        const BlurredDistance blurred = blur(s.normal_x * px + s.normal_y * py - s.at, s.noise);
        rows[0][i] = member;
        rows[1][i] = member * px;
        rows[2][i] = member * py;
        rows[3][i] = member * px * px;
        rows[4][i] = member * px * py;
        rows[5][i] = member * py * py;
        rows[6][i] = member * blurred.distance;
        rows[7][i] = member * blurred.sign;
        rows[8][i] = member * blurred.sign * along;
        rows[9][i] = member * z[i];
    }
    for (auto& row : rows) std::fill(row + size, row + kBlock, 0.0F);
}

LPF_MULTIVERSION
void add_products(const Rows& rows, double* out) {
    for (int i = 0; i < kCreaseRows; ++i) {
        for (int j = 0; j <= i; ++j) {
            float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
            for (std::size_t k = 0; k < kBlock; ++k) sum += rows[i][k] * rows[j][k];
            out[i * kCreaseRows + j] += static_cast<double>(sum);
        }
    }
}

}  // namespace

LPF_MULTIVERSION
void offsets_from_crease(const CreasedSurface& s, const float* x, const float* y, const float* z,
                         std::size_t n, float* out) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float distance = blur(s.normal_x * x[i] + s.normal_y * y[i] - s.at, s.noise).distance;
        const float d = z[i] - parabola(s.c, x[i], y[i]) - s.slope * distance;
        out[i] = d * d;
    }
}

LPF_MULTIVERSION
void line_sums(float normal_x, float normal_y, float at, const float* x, const float* y,
               const float* z, const float* weight, std::size_t n, float out[5]) {
    float d0 = 0, dx = 0, dy = 0, dd = 0, dz = 0;
#pragma omp simd reduction(+ : d0, dx, dy, dd, dz)
    for (std::size_t i = 0; i < n; ++i) {
        const float d = std::abs(normal_x * x[i] + normal_y * y[i] - at);
        const float weighted = weight[i] * d;
        d0 += weighted, dx += weighted * x[i], dy += weighted * y[i];
        dd += weighted * d, dz += weighted * z[i];
    }
    out[0] = d0, out[1] = dx, out[2] = dy, out[3] = dd, out[4] = dz;
}

void crease_moments(const CreasedSurface& surface, const float* x, const float* y, const float* z,
                    const float* off, float limit, std::size_t n, std::size_t stride, double* out) {
    std::fill_n(out, kCreaseRows * kCreaseRows, 0.0);
    Rows rows;
    float chosen[4][kBlock];
    for (std::size_t begin = 0; begin < n;) {
        std::size_t size = 0;
        for (; size < kBlock && begin < n; ++size, begin += stride) {
            chosen[0][size] = x[begin];
            chosen[1][size] = y[begin];
            chosen[2][size] = z[begin];
            chosen[3][size] = off[begin];
        }
        fill_rows(surface, chosen[0], chosen[1], chosen[2], chosen[3], limit, size, rows);
        add_products(rows, out);
    }
}

}  // namespace lpf::kernels
