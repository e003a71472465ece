#pragma once

#include "tests/bench/accuracy/cases.h"

namespace lpf::accuracy {

[[nodiscard]] Case resampling_case();

}  // namespace lpf::accuracy
