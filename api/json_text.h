#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "api/limits.h"

namespace lpf {

/// Text from a stranger to JSON. A byte order mark is skipped; duplicate keys are refused, because
/// readers that disagree about which one counts can be played against each other.
/// @throws ProblemException{MalformedJson} with the byte position, {PayloadTooLarge} over
///         limits.json_bytes, {LimitExceeded} over json_depth or json_string_bytes
[[nodiscard]] nlohmann::json parse_json(std::string_view text, const Limits& limits);

/// Compact text. Never throws: invalid UTF-8 becomes U+FFFD.
[[nodiscard]] std::string dump_json(const nlohmann::json& json);

}  // namespace lpf
