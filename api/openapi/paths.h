#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "api/limits.h"
#include "core/auto_parameters.h"

namespace lpf::openapi {

/// Every path of the service with its operations.
[[nodiscard]] nlohmann::json paths(const Limits& limits);

/// The paths of jobs and of their results.
[[nodiscard]] nlohmann::json job_paths();

/// The paths that start jobs, one per process.
[[nodiscard]] nlohmann::json execution_paths(const Limits& limits);

/// The paths that tell of a job before it runs and while it does.
[[nodiscard]] nlohmann::json live_paths(const Limits& limits);

/// components/parameters and components/headers of those.
[[nodiscard]] nlohmann::json live_parameters();
[[nodiscard]] nlohmann::json live_headers();

/// "Denoise", ...: how the names of a process's schemas begin.
[[nodiscard]] std::string schema_prefix(Task task);

/// The three forms in which a shape and the inputs of a process can be sent.
[[nodiscard]] nlohmann::json shape_body(Task task);

}  // namespace lpf::openapi
