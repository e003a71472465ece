#pragma once

#include <string>

#include "api/codec/format.h"

namespace lpf::test {

/// What a PLY or Draco file holds.
/// @throws Error if it cannot be read
[[nodiscard]] Document read_scan(const std::string& path);

/// The same, of a file with triangles.
/// @throws Error{InvalidParameter} without any
[[nodiscard]] Shape read_mesh(const std::string& path);

}  // namespace lpf::test
