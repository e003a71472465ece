#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace lpf {

/// What bytes that are neither PLY nor Draco look like, for a message: "an OBJ file", "gzip data".
[[nodiscard]] std::string describe_foreign(std::span<const std::byte> bytes);

}  // namespace lpf
