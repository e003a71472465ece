#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "api/limits.h"

namespace lpf {

/// GET /v1/openapi.json: the whole contract as OpenAPI 3.1, made from the tables of parameters,
/// problems and limits.
[[nodiscard]] nlohmann::json openapi_document(const Limits& limits, std::string_view version,
                                              std::string_view server_url);

}  // namespace lpf
