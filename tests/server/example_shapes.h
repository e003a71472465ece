#pragma once

#include <cstdint>
#include <string>

namespace lpf::server {

/// A wavy, slightly noisy square of side x side points as ASCII PLY, with colours and a number a
/// point.
[[nodiscard]] inline std::string wavy_square(int side) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(side * side) +
                       "\nproperty float x\nproperty float y\nproperty float z\n"
                       "property uchar red\nproperty int number\nend_header\n";
    std::uint32_t noise = 1;
    for (int i = 0; i < side * side; ++i) {
        noise = noise * 1664525U + 1013904223U;
        const int height = (i % side) * (i / side) % 7 + static_cast<int>(noise >> 29U);
        text += std::to_string(i % side) + " " + std::to_string(i / side) + " 0." +
                std::to_string(height) + " " + std::to_string(i % 256) + " " + std::to_string(i) +
                "\n";
    }
    return text;
}

}  // namespace lpf::server
