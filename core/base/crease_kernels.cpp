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
void subtract_crease(const CreasedSurface& s, const float* x, const float* y, std::size_t n,
                     float* z) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float distance = blur(s.normal_x * x[i] + s.normal_y * y[i] - s.at, s.noise).distance;
        z[i] -= parabola(s.c, x[i], y[i]) + s.slope * distance;
    }
}

namespace {

template <int kWidth>
LPF_INLINE void line_sums_in(const Lines& lines, const float* x, const float* y, const float* z,
                             const float* weight, std::size_t n, float* out) {
    using Floats = typename Registers<kWidth>::Floats;
    for (std::size_t k = 0; k < lines.count; k += kWidth) {
        const Floats normal_x = floats_at<kWidth>(lines.normal_x + k);
        const Floats normal_y = floats_at<kWidth>(lines.normal_y + k);
        const Floats at = floats_at<kWidth>(lines.at + k);
        Floats sums[5] = {};
        for (std::size_t i = 0; i < n; ++i) {
            const Floats signed_distance = normal_x * x[i] + normal_y * y[i] - at;
            const Floats d = signed_distance < 0 ? -signed_distance : signed_distance;
            const Floats weighted = weight[i] * d;
            sums[0] += weighted;
            sums[1] += weighted * x[i];
            sums[2] += weighted * y[i];
            sums[3] += weighted * d;
            sums[4] += weighted * z[i];
        }
        for (std::size_t row = 0; row < 5; ++row) {
            floats_at<kWidth>(out + row * lines.count + k) = sums[row];
        }
    }
}

}  // namespace

LPF_WITH_REGISTERS(void, line_sums,
                   (const Lines& lines, const float* x, const float* y, const float* z,
                    const float* weight, std::size_t n, float* out),
                   (lines, x, y, z, weight, n, out))

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
