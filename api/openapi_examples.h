#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/auto_parameters.h"

namespace lpf::openapi {

/// A JSON execution request.
[[nodiscard]] nlohmann::json execution_example();

/// A job that runs.
[[nodiscard]] nlohmann::json status_example(Task task);

}  // namespace lpf::openapi
