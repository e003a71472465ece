#pragma once

#include "tests/bench/accuracy/cases.h"

namespace lpf::accuracy {

/// Points of a shape, denoised with no parameter given.
[[nodiscard]] Points denoised(const Points& points, const Conditions& conditions);

}  // namespace lpf::accuracy
