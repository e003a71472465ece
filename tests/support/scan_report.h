#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tests/support/metrics.h"

namespace lpf::test {

/// In the units of the input, and in per cent of `diagonal`.
nlohmann::ordered_json to_json(const ErrorStats& stats, double diagonal);

/// Parts that have no points are left out.
nlohmann::ordered_json to_json(const PartErrors& errors);

/// Parts that the shape has not are left out.
nlohmann::ordered_json to_json(const ShapeCoverage& coverage);

/// Distances to the nearest other point; variation = standard deviation / mean.
nlohmann::ordered_json to_json(const NeighbourStats& stats);

}  // namespace lpf::test
