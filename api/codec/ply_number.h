#pragma once

#include "core/shape/attribute.h"

namespace lpf {

/// Reads the number at `at`, which must be of `type`, into `out` in the machine's byte order; `at`
/// moves behind it. No locale, "nan" and "inf" included; 255.0 counts as the integer it is.
/// @returns false if there is no such number, or it does not fit the type
[[nodiscard]] bool parse_number(ScalarType type, const char*& at, const char* end, std::byte* out);

}  // namespace lpf
