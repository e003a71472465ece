#pragma once

#include <nlohmann/json_fwd.hpp>

#include "api/limits.h"

namespace lpf::openapi {

/// Every path of the service with its operations.
[[nodiscard]] nlohmann::json paths(const Limits& limits);

/// The paths of jobs and of their results.
[[nodiscard]] nlohmann::json job_paths();

/// The paths that start jobs, one per process.
[[nodiscard]] nlohmann::json execution_paths(const Limits& limits);

}  // namespace lpf::openapi
