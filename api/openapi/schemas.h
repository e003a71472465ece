#pragma once

#include <nlohmann/json_fwd.hpp>

#include "api/limits.h"

namespace lpf::openapi {

/// components/schemas of jobs, problems, shapes and the service itself.
[[nodiscard]] nlohmann::json service_schemas(const Limits& limits);

/// components/schemas of what a job leaves behind.
[[nodiscard]] nlohmann::json result_schemas();

/// components/schemas of what is told of a job before it runs and while it does.
[[nodiscard]] nlohmann::json live_schemas();

}  // namespace lpf::openapi
