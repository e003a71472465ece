#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/analysis.h"

namespace lpf {

/// A float as the shortest number that reads back as the same float: 0.1, not 0.10000000149.
[[nodiscard]] double shortest(float value);

/// The energy at the end of each iteration: [3.2, 1.9, ...].
[[nodiscard]] nlohmann::json energy_to_json(const std::vector<IterationEnergy>& energy);

/// The energy after each step: [{learning, pose, probing}, ...].
[[nodiscard]] nlohmann::json energy_steps_to_json(const std::vector<IterationEnergy>& energy);

}  // namespace lpf
