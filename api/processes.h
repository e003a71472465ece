#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "api/limits.h"
#include "core/auto_parameters.h"

namespace lpf {

/// GET /v1/processes: {processes: [summaries], links}.
[[nodiscard]] nlohmann::json process_list(std::string_view version);

/// GET /v1/processes/{id}: every input with its JSON Schema, every output.
[[nodiscard]] nlohmann::json process_description(Task task, const Limits& limits,
                                                 std::string_view version);

}  // namespace lpf
