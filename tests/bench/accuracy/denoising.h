#pragma once

#include "tests/bench/accuracy/cases.h"

namespace lpf::accuracy {

[[nodiscard]] std::vector<Case> denoising_cases();

}  // namespace lpf::accuracy
