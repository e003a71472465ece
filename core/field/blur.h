#pragma once

#include <cmath>
#include <numbers>

namespace lpf {

/// What Gaussian noise makes of the distance to a line: the mean of |d + noise|.
/// @param noise standard deviation, > 0
inline float blurred_distance(float d, float noise) {
    const float t = d / noise;
    if (std::abs(t) > 4) return std::abs(d);
    constexpr float kDensity = 0.79788456F;  // sqrt(2 / pi)
    return d * std::erf(t / std::numbers::sqrt2_v<float>) +
           noise * kDensity * std::exp(-0.5F * t * t);
}

/// Its derivative with respect to d.
inline float blurred_sign(float d, float noise) {
    return std::erf(d / noise / std::numbers::sqrt2_v<float>);
}

}  // namespace lpf
