#pragma once

namespace lpf {

/// c . (1, x, y, xx, xy, yy).
inline float parabola(const float* c, float x, float y) {
    return c[0] + x * (c[1] + x * c[3] + y * c[4]) + y * (c[2] + y * c[5]);
}

/// c . (1, x, xx, xxx).
inline float cubic(const float* c, float x) { return c[0] + x * (c[1] + x * (c[2] + x * c[3])); }

}  // namespace lpf
