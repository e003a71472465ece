#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/auto_parameters.h"

namespace lpf::openapi {

/// A JSON execution request.
[[nodiscard]] nlohmann::json execution_example();

/// A job that runs.
[[nodiscard]] nlohmann::json status_example(Task task);

/// What is foreseen of a job.
[[nodiscard]] nlohmann::json validation_example(Task task);

/// A few events, as text.
[[nodiscard]] std::string events_example();

}  // namespace lpf::openapi
