#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/shape/noise.h"

namespace lpf {

/// What was measured on a shape, as reports and answers to questions give it.
[[nodiscard]] nlohmann::json to_json(const Measurements& measured);

}  // namespace lpf
