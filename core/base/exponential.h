#pragma once

#include <cstring>

namespace lpf {

/// exp(v) for v <= 0, to 2e-7 (1 + |v|) of it, as arithmetic that runs in lanes: the library's does
/// not, unless all of floating point is loosened by -ffast-math.
inline float exponential(float v) {
    const float limited = v > -87.0F ? v : -87.0F;
    const float t = limited * 1.44269504F;
    const int whole = static_cast<int>(t - 0.5F);
    const float f = (t - static_cast<float>(whole)) * 0.693147181F;  // within +-ln(2) / 2
    const float power =
        1 +
        f * (1 + f * (0.5F + f * (0.166666667F + f * (0.0416666667F +
                                                      f * (0.00833333333F + f * 0.00138888889F)))));
    const int bits = (whole + 127) * (1 << 23);
    float scale = 0;
    std::memcpy(&scale, &bits, sizeof scale);
    return scale * power;
}

}  // namespace lpf
