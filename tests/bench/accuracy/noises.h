#pragma once

#include "tests/bench/accuracy/cases.h"

namespace lpf::accuracy {

/// Noise that is not normal, or not the same everywhere and in all directions.
[[nodiscard]] Case other_noises();

}  // namespace lpf::accuracy
