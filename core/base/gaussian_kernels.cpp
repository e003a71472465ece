#include "core/base/gaussian_kernels.h"

#include "core/base/exponential.h"
#include "core/base/multiversion.h"

namespace lpf::kernels {
namespace {

/// exp(-squared / 2) to .005: (1 - v / 64)^64 is near exp(-v), and arithmetic that runs in lanes.
inline float gaussian(float squared) {
    float power = 1 - squared / 128;
    for (int doublings = 0; doublings < 6; ++doublings) power *= power;
    return squared <= kGaussianReach * kGaussianReach ? power : 0.0F;
}

}  // namespace

LPF_MULTIVERSION
float gaussian_sum(const float place[3], float sharpness, const float* x, const float* y,
                   const float* z, std::size_t n) {
    const float scale = sharpness * sharpness;
    const float px = place[0];
    const float py = place[1];
    const float pz = place[2];
    float sum = 0.0F;
#pragma omp simd reduction(+ : sum)
    for (std::size_t i = 0; i < n; ++i) {
        const float dx = x[i] - px;
        const float dy = y[i] - py;
        const float dz = z[i] - pz;
        sum += gaussian(scale * (dx * dx + dy * dy + dz * dz));
    }
    return sum;
}

LPF_MULTIVERSION
GaussianMoments gaussian_moments(const float place[3], const float* x, const float* y,
                                 const float* z, const float* weight, std::size_t n) {
    const float px = place[0];
    const float py = place[1];
    const float pz = place[2];
    float sum = 0, sum_x = 0, sum_y = 0, sum_z = 0, squares = 0;
#pragma omp simd reduction(+ : sum, sum_x, sum_y, sum_z, squares)
    for (std::size_t i = 0; i < n; ++i) {
        const float dx = x[i] - px;
        const float dy = y[i] - py;
        const float dz = z[i] - pz;
        const float squared = dx * dx + dy * dy + dz * dz;
        const float w = weight[i] * gaussian(squared);
        sum += w, sum_x += w * dx, sum_y += w * dy, sum_z += w * dz;
        squares += w * w * squared;
    }
    return {sum, sum_x, sum_y, sum_z, squares};
}

LPF_MULTIVERSION
GaussianMean gaussian_mean(const float place[3], float sharpness, const float* x, const float* y,
                           const float* z, std::size_t n) {
    const float scale = -0.5F * sharpness * sharpness;
    const float px = place[0];
    const float py = place[1];
    const float pz = place[2];
    float sum = 0, sum_x = 0, sum_y = 0, sum_z = 0;
#pragma omp simd reduction(+ : sum, sum_x, sum_y, sum_z)
    for (std::size_t i = 0; i < n; ++i) {
        const float dx = x[i] - px;
        const float dy = y[i] - py;
        const float dz = z[i] - pz;
        const float w = exponential(scale * (dx * dx + dy * dy + dz * dz));
        sum += w, sum_x += w * x[i], sum_y += w * y[i], sum_z += w * z[i];
    }
    return {sum, sum_x, sum_y, sum_z};
}

}  // namespace lpf::kernels
