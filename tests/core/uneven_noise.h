#pragma once

#include <vector>

#include "tests/support/shapes.h"

namespace lpf::test {

/// A scan whose noise rises eightfold along x.
struct UnevenScan {
    Points points;
    std::vector<double> noise;  ///< standard deviation of each point
};

/// @param exact without noise @param share of the diagonal that the least noise is
UnevenScan make_uneven(const TestShape& exact, double share = 0.0015);

}  // namespace lpf::test
