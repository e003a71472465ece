#include "core/base/kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/multiversion.h"

namespace lpf::kernels {
LPF_MULTIVERSION
float dot(const float* a, const float* b, std::size_t n) {
    float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
}

LPF_MULTIVERSION
float squared_distance(const float* a, const float* b, std::size_t n) {
    float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

void to_panels(const float* values, std::size_t rows, std::size_t n, float* out) {
    for (std::size_t first = 0; first < n; first += kPanel) {
        const std::size_t width = std::min(kPanel, n - first);
        for (std::size_t i = 0; i < rows; ++i) {
            out = std::copy_n(values + i * n + first, width, out);
        }
    }
}

namespace {

/// Rows of a matrix, `stride` floats from one to the next.
struct Rows {
    const float* values;
    std::size_t stride;
};

/// Rows of left that are multiplied together, with two registers of columns: so many sums that the
/// adders are busy, and so few that they stay in registers.
template <int kWidth>
constexpr std::size_t kRowsOfTile = kWidth == 16 ? 8 : 4;

/// The product of the rows of a tile (or fewer) with two registers (or one) of columns.
/// @param inner values of a row of left, and rows of right
/// kAdds: to what is in out, else to zero.
template <int kWidth, bool kAdds>
LPF_INLINE void multiply_tile(Rows left, std::size_t rows, std::size_t inner, Rows right,
                              std::size_t registers, float* out, std::size_t n) {
    using Floats = typename Registers<kWidth>::Floats;
    constexpr std::size_t kRows = kRowsOfTile<kWidth>;
    const std::size_t next = (registers - 1) * kWidth;
    const float* from[kRows];
    float* to[kRows];
    Floats s[kRows], t[kRows];
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kRows; ++k) {
        const std::size_t row = k < rows ? k : 0;
        from[k] = left.values + row * left.stride;
        to[k] = out + row * n;
        s[k] = kAdds ? floats_at<kWidth>(to[k]) : Floats{};
        t[k] = kAdds ? floats_at<kWidth>(to[k] + next) : Floats{};
    }
    for (std::size_t i = 0; i < inner; ++i) {
        const Floats first = floats_at<kWidth>(right.values + i * right.stride);
        const Floats second = floats_at<kWidth>(right.values + i * right.stride + next);
#pragma GCC unroll 8
        for (std::size_t k = 0; k < kRows; ++k) {
            s[k] += from[k][i] * first;
            t[k] += from[k][i] * second;
        }
    }
#pragma GCC unroll 8
    for (std::size_t k = 0; k < kRows; ++k) {
        if (k >= rows) break;
        floats_at<kWidth>(to[k]) = s[k];
        floats_at<kWidth>(to[k] + next) = t[k];
    }
}

/// The product of some rows with `columns` of right, whole registers of them.
template <int kWidth, bool kAdds>
LPF_INLINE void multiply_columns(Rows left, std::size_t count, std::size_t inner, Rows right,
                                 std::size_t columns, float* out, std::size_t n) {
    constexpr std::size_t kRows = kRowsOfTile<kWidth>;
    for (std::size_t j = 0; j < columns; j += 2 * kWidth) {
        const std::size_t registers = j + kWidth < columns ? 2 : 1;
        for (std::size_t first = 0; first < count; first += kRows) {
            const std::size_t rows = count - first < kRows ? count - first : kRows;
            multiply_tile<kWidth, kAdds>({left.values + first * left.stride, left.stride}, rows,
                                         inner, {right.values + j, right.stride}, registers,
                                         out + first * n + j, n);
        }
    }
}

/// So many rows of right, in two registers, stay in the first cache while all of left passes by.
constexpr std::size_t kInner = 128;

template <int kWidth>
LPF_INLINE void multiply_in(const float* left, std::size_t count, std::size_t inner,
                            const float* right, std::size_t n, float* out) {
    for (std::size_t first = 0; first < n; first += kPanel) {
        const std::size_t width = n - first < kPanel ? n - first : kPanel;
        const Rows panel{right + first * inner, width};
        const std::size_t size = inner < kInner ? inner : kInner;
        multiply_columns<kWidth, false>({left, inner}, count, size, panel, width, out + first, n);
        for (std::size_t begin = size; begin < inner; begin += kInner) {
            const std::size_t some = inner - begin < kInner ? inner - begin : kInner;
            multiply_columns<kWidth, true>({left + begin, inner}, count, some,
                                           {panel.values + begin * width, width}, width,
                                           out + first, n);
        }
    }
}

template <int kWidth>
LPF_INLINE void add_product_in(const float* left, std::size_t count, std::size_t inner,
                               const float* right, std::size_t n, float* out) {
    const std::size_t whole = n - n % kWidth;
    for (std::size_t begin = 0; begin < inner; begin += kInner) {
        const std::size_t size = inner - begin < kInner ? inner - begin : kInner;
        const float* const from = right + begin * n;
        multiply_columns<kWidth, true>({left + begin, inner}, count, size, {from, n}, whole, out,
                                       n);
        for (std::size_t k = 0; k < count; ++k) {
            for (std::size_t j = whole; j < n; ++j) {
                float sum = out[k * n + j];
                for (std::size_t i = 0; i < size; ++i) {
                    sum += left[k * inner + begin + i] * from[i * n + j];
                }
                out[k * n + j] = sum;
            }
        }
    }
}

template <int kWidth>
LPF_INLINE void combine_rows_in(const float* rows, std::size_t stride, std::size_t n,
                                const unsigned* row, const float* coefficient, std::size_t count,
                                float* out) {
    using Floats = typename Registers<kWidth>::Floats;
    // A block of outputs stays in registers while all rows pass over it.
    constexpr std::size_t kBlock = 4 * kWidth;
    std::size_t begin = 0;
    for (; begin + kBlock <= n; begin += kBlock) {
        Floats s0{}, s1{}, s2{}, s3{};
        for (std::size_t k = 0; k < count; ++k) {
            const float* const from = rows + row[k] * stride + begin;
            s0 += coefficient[k] * floats_at<kWidth>(from);
            s1 += coefficient[k] * floats_at<kWidth>(from + kWidth);
            s2 += coefficient[k] * floats_at<kWidth>(from + 2 * kWidth);
            s3 += coefficient[k] * floats_at<kWidth>(from + 3 * kWidth);
        }
        floats_at<kWidth>(out + begin) = s0;
        floats_at<kWidth>(out + begin + kWidth) = s1;
        floats_at<kWidth>(out + begin + 2 * kWidth) = s2;
        floats_at<kWidth>(out + begin + 3 * kWidth) = s3;
    }
    for (; begin + kWidth <= n; begin += kWidth) {
        Floats sum{};
        for (std::size_t k = 0; k < count; ++k) {
            sum += coefficient[k] * floats_at<kWidth>(rows + row[k] * stride + begin);
        }
        floats_at<kWidth>(out + begin) = sum;
    }
    for (; begin < n; ++begin) {
        float sum = 0;
        for (std::size_t k = 0; k < count; ++k)
            sum += coefficient[k] * rows[row[k] * stride + begin];
        out[begin] = sum;
    }
}

}  // namespace

LPF_WITH_REGISTERS(void, multiply,
                   (const float* left, std::size_t count, std::size_t inner, const float* right,
                    std::size_t n, float* out),
                   (left, count, inner, right, n, out))

LPF_WITH_REGISTERS(void, add_product,
                   (const float* left, std::size_t count, std::size_t inner, const float* right,
                    std::size_t n, float* out),
                   (left, count, inner, right, n, out))

LPF_WITH_REGISTERS(void, combine_rows,
                   (const float* rows, std::size_t stride, std::size_t n, const unsigned* row,
                    const float* coefficient, std::size_t count, float* out),
                   (rows, stride, n, row, coefficient, count, out))

LPF_MULTIVERSION
void add_scaled(float scale, const float* in, float* out, std::size_t n) {
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) out[i] += scale * in[i];
}

LPF_MULTIVERSION
PairMoments pair_moments(const float* u, const float* v, const float* w, std::size_t n) {
    float ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0;
    float xx = 0, xy = 0, xz = 0, yx = 0, yy = 0, yz = 0, zx = 0, zy = 0, zz = 0;
#pragma omp simd reduction(+ : ax, ay, az, bx, by, bz, xx, xy, xz, yx, yy, yz, zx, zy, zz)
    for (std::size_t i = 0; i < n; ++i) {
        const float px = u[i] + v[i];
        const float py = u[n + i] + v[n + i];
        const float pz = u[2 * n + i] + v[2 * n + i];
        const float qx = u[i] + w[i];
        const float qy = u[n + i] + w[n + i];
        const float qz = u[2 * n + i] + w[2 * n + i];
        ax += px, ay += py, az += pz;
        bx += qx, by += qy, bz += qz;
        xx += px * qx, xy += px * qy, xz += px * qz;
        yx += py * qx, yy += py * qy, yz += py * qz;
        zx += pz * qx, zy += pz * qy, zz += pz * qz;
    }
    return {{ax, ay, az}, {bx, by, bz}, {xx, xy, xz, yx, yy, yz, zx, zy, zz}};
}

LPF_MULTIVERSION
void move_points(const float* rotation, const float* translation, const float* u, std::size_t n,
                 float* v) {
    const float r0 = rotation[0], r1 = rotation[1], r2 = rotation[2];
    const float r3 = rotation[3], r4 = rotation[4], r5 = rotation[5];
    const float r6 = rotation[6], r7 = rotation[7], r8 = rotation[8];
    const float tx = translation[0], ty = translation[1], tz = translation[2];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float ux = u[i], uy = u[n + i], uz = u[2 * n + i];
        const float px = ux + v[i], py = uy + v[n + i], pz = uz + v[2 * n + i];
        v[i] = r0 * px + r1 * py + r2 * pz + tx - ux;
        v[n + i] = r3 * px + r4 * py + r5 * pz + ty - uy;
        v[2 * n + i] = r6 * px + r7 * py + r8 * pz + tz - uz;
    }
}

LPF_MULTIVERSION
void to_frame(const float* axes, const float* origin, float* x, float* y, float* z, std::size_t n) {
    const float ox = origin[0], oy = origin[1], oz = origin[2];
    const float a0 = axes[0], a1 = axes[1], a2 = axes[2];
    const float a3 = axes[3], a4 = axes[4], a5 = axes[5];
    const float a6 = axes[6], a7 = axes[7], a8 = axes[8];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float px = x[i] - ox;
        const float py = y[i] - oy;
        const float pz = z[i] - oz;
        x[i] = a0 * px + a3 * py + a6 * pz;
        y[i] = a1 * px + a4 * py + a7 * pz;
        z[i] = a2 * px + a5 * py + a8 * pz;
    }
}

LPF_MULTIVERSION
void second_moments(const float* x, const float* y, const float* z, std::size_t n, float out[9]) {
    float sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
#pragma omp simd reduction(+ : sx, sy, sz, xx, xy, xz, yy, yz, zz)
    for (std::size_t i = 0; i < n; ++i) {
        sx += x[i], sy += y[i], sz += z[i];
        xx += x[i] * x[i], xy += x[i] * y[i], xz += x[i] * z[i];
        yy += y[i] * y[i], yz += y[i] * z[i], zz += z[i] * z[i];
    }
    const float sums[9] = {sx, sy, sz, xx, xy, xz, yy, yz, zz};
    for (int k = 0; k < 9; ++k) out[k] = sums[k];
}

LPF_MULTIVERSION
void parabola_moments(const float* x, const float* y, const float* z, const float* off, float limit,
                      std::size_t n, float out[21]) {
    float s = 0, sx = 0, sy = 0, xx = 0, xy = 0, yy = 0, xxx = 0, xxy = 0, xyy = 0, yyy = 0;
    float xxxx = 0, xxxy = 0, xxyy = 0, xyyy = 0, yyyy = 0;
    float sz = 0, xz = 0, yz = 0, xxz = 0, xyz = 0, yyz = 0;
#pragma omp simd reduction(+ : s, sx, sy, xx, xy, yy, xxx, xxy, xyy, yyy, xxxx, xxxy, xxyy, xyyy, \
                               yyyy, sz, xz, yz, xxz, xyz, yyz)
    for (std::size_t i = 0; i < n; ++i) {
        const float w = off[i] <= limit ? 1.0F : 0.0F;
        const float px = w * x[i], py = w * y[i], pz = w * z[i];
        const float px2 = px * px, pxy = px * py, py2 = py * py;
        s += w, sx += px, sy += py;
        xx += px2, xy += pxy, yy += py2;
        xxx += px2 * px, xxy += px2 * py, xyy += px * py2, yyy += py2 * py;
        xxxx += px2 * px2, xxxy += px2 * pxy, xxyy += px2 * py2, xyyy += pxy * py2;
        yyyy += py2 * py2;
        sz += pz, xz += px * pz, yz += py * pz;
        xxz += px2 * pz, xyz += pxy * pz, yyz += py2 * pz;
    }
    const float sums[21] = {s,    sx,   sy,   xx,   xy, yy, xxx, xxy, xyy, yyy, xxxx,
                            xxxy, xxyy, xyyy, yyyy, sz, xz, yz,  xxz, xyz, yyz};
    for (int k = 0; k < 21; ++k) out[k] = sums[k];
}

LPF_MULTIVERSION
void offsets_from_parabola(const float c[6], const float* x, const float* y, const float* z,
                           std::size_t n, float* out) {
    const float c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3], c4 = c[4], c5 = c[5];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float d = z[i] - (c0 + x[i] * (c1 + x[i] * c3 + y[i] * c4) + y[i] * (c2 + y[i] * c5));
        out[i] = d * d;
    }
}

LPF_MULTIVERSION
void subtract_parabola(const float c[6], const float* x, const float* y, std::size_t n, float* z) {
    const float c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3], c4 = c[4], c5 = c[5];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        z[i] -= c0 + x[i] * (c1 + x[i] * c3 + y[i] * c4) + y[i] * (c2 + y[i] * c5);
    }
}

LPF_MULTIVERSION
void offsets_from_cubics(const float c[8], const float* x, const float* y, const float* z,
                         std::size_t n, float* out) {
    const float a0 = c[0], a1 = c[1], a2 = c[2], a3 = c[3];
    const float b0 = c[4], b1 = c[5], b2 = c[6], b3 = c[7];
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float dy = y[i] - (a0 + x[i] * (a1 + x[i] * (a2 + x[i] * a3)));
        const float dz = z[i] - (b0 + x[i] * (b1 + x[i] * (b2 + x[i] * b3)));
        out[i] = dy * dy + dz * dz;
    }
}

LPF_MULTIVERSION
void block_numbers(const float* x, const float* y, float extent, int side, std::size_t n,
                   unsigned* out) {
    const auto count = static_cast<float>(side);
    const auto last = static_cast<float>(side - 1);
#pragma omp simd
    for (std::size_t i = 0; i < n; ++i) {
        const float along = (x[i] / extent + 1) / 2 * count;
        const float across = (y[i] / extent + 1) / 2 * count;
        const float column = along < 0 ? 0.0F : along > last ? last : along;
        const float row = across < 0 ? 0.0F : across > last ? last : across;
        out[i] = static_cast<unsigned>(static_cast<int>(row) * side + static_cast<int>(column));
    }
}

}  // namespace lpf::kernels
