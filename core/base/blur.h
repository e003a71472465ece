#pragma once

#include <cmath>

#include "core/base/exponential.h"

namespace lpf {

/// What Gaussian noise makes of the distance to a line.
struct BlurredDistance {
    float distance;  ///< mean of |d + noise|
    float sign;      ///< its derivative with respect to d
};

/// @param noise standard deviation, > 0
inline BlurredDistance blur(float d, float noise) {
    const float t = std::abs(d) / noise;
    // erf by Abramowitz and Stegun 7.1.26, which shares the exponential: to 1.5e-7.
    const float gauss = exponential(-0.5F * t * t);
    const float s = 1.0F / (1.0F + 0.23164189F * t);
    const float polynomial =
        s * (0.254829592F +
             s * (-0.284496736F + s * (1.421413741F + s * (-1.453152027F + s * 1.061405429F))));
    const float erf = 1.0F - polynomial * gauss;
    constexpr float kDensity = 0.79788456F;  // sqrt(2 / pi)
    return {std::abs(d) * erf + noise * kDensity * gauss, std::copysign(erf, d)};
}

}  // namespace lpf
