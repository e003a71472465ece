#include "core/base/kernels.h"

// One binary runs on every x86-64 and uses what the machine has. Elsewhere, and under sanitizers,
// the plain loops are compiled once.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LPF_NO_MULTIVERSION)
#define LPF_MULTIVERSION \
    __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define LPF_MULTIVERSION
#endif

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

LPF_MULTIVERSION
void multiply_rows(const float* rows, std::size_t row_count, std::size_t n, const float* v,
                   float* out) {
    std::size_t k = 0;
    // Four rows at a time share the loads of v.
    for (; k + 4 <= row_count; k += 4) {
        const float* r0 = rows + k * n;
        const float* r1 = r0 + n;
        const float* r2 = r1 + n;
        const float* r3 = r2 + n;
        float s0 = 0.0F;
        float s1 = 0.0F;
        float s2 = 0.0F;
        float s3 = 0.0F;
#pragma omp simd reduction(+ : s0, s1, s2, s3)
        for (std::size_t i = 0; i < n; ++i) {
            s0 += r0[i] * v[i];
            s1 += r1[i] * v[i];
            s2 += r2[i] * v[i];
            s3 += r3[i] * v[i];
        }
        out[k] = s0;
        out[k + 1] = s1;
        out[k + 2] = s2;
        out[k + 3] = s3;
    }
    for (; k < row_count; ++k) {
        float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
        for (std::size_t i = 0; i < n; ++i) sum += rows[k * n + i] * v[i];
        out[k] = sum;
    }
}

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
void convolve(const float* in, float* out, std::size_t n, int stride, const float* taps,
              int reach) {
    // A block of outputs stays in registers while all taps pass over it.
    constexpr std::size_t kBlock = 64;
    for (std::size_t begin = 0; begin < n; begin += kBlock) {
        const std::size_t size = n - begin < kBlock ? n - begin : kBlock;
        float sums[kBlock] = {};
        for (int k = -reach; k <= reach; ++k) {
            const float* from =
                in + static_cast<std::ptrdiff_t>(begin) + static_cast<std::ptrdiff_t>(k) * stride;
            const float tap = taps[k];
            if (size == kBlock) {
#pragma omp simd
                for (std::size_t i = 0; i < kBlock; ++i) sums[i] += tap * from[i];
            } else {
#pragma omp simd
                for (std::size_t i = 0; i < size; ++i) sums[i] += tap * from[i];
            }
        }
        for (std::size_t i = 0; i < size; ++i) out[begin + i] = sums[i];
    }
}

LPF_MULTIVERSION
std::size_t gather_ball(const double* x, const double* y, const double* z, std::size_t n,
                        const double centre[3], double scale, float limit, std::size_t first,
                        float* out_x, float* out_y, float* out_z, unsigned* out_index) {
    const double cx = centre[0], cy = centre[1], cz = centre[2];
    const float squared_limit = limit * limit;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto dx = static_cast<float>((x[i] - cx) * scale);
        const auto dy = static_cast<float>((y[i] - cy) * scale);
        const auto dz = static_cast<float>((z[i] - cz) * scale);
        out_x[kept] = dx;
        out_y[kept] = dy;
        out_z[kept] = dz;
        out_index[kept] = static_cast<unsigned>(first + i);
        kept += static_cast<std::size_t>(dx * dx + dy * dy + dz * dz <= squared_limit);
    }
    return kept;
}

}  // namespace lpf::kernels
