#pragma once

#include "tests/paper/workbench.h"

namespace lpf::paper {

/// A shape as it is scanned and as it is resampled: a row for each, with errors and coverage.
[[nodiscard]] Table upsampling_table(const TestShape& shape, const Resampled& result);

}  // namespace lpf::paper
