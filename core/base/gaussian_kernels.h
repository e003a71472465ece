#pragma once

#include <cstddef>

/// Sums over the points near a place, each counting as much as isotropic noise of unit standard
/// deviation is likely to lead from one to the other: exp(-d^2 / 2), and 0 beyond kGaussianReach.
/// Structure of arrays of n floats each.
namespace lpf::kernels {

inline constexpr float kGaussianReach = 3.0F;

/// The sum of exp(-(sharpness d)^2 / 2) over points at distances d from `place`.
float gaussian_sum(const float place[3], float sharpness, const float* x, const float* y,
                   const float* z, std::size_t n);

/// With w the weights times exp(-d^2 / 2), and (dx, dy, dz) what leads from `place` to a point.
struct GaussianMoments {
    float weight;     ///< sum of w
    float x, y, z;    ///< sums of w dx, w dy, w dz
    float by_chance;  ///< sum of (w d)^2: the squared length of (x, y, z) if all were independent
};
GaussianMoments gaussian_moments(const float place[3], const float* x, const float* y,
                                 const float* z, const float* weight, std::size_t n);

/// Points under exp(-(sharpness d)^2 / 2), all of them, at distances d from `place`: where they are
/// on average is (x, y, z) / weight.
struct GaussianMean {
    float weight;   ///< sum of the weights
    float x, y, z;  ///< sums of the weighted coordinates
};
GaussianMean gaussian_mean(const float place[3], float sharpness, const float* x, const float* y,
                           const float* z, std::size_t n);

}  // namespace lpf::kernels
