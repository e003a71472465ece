#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lpf::test {

/// Faults of a value against a schema of an OpenAPI 3.1 document, each with the place it lies at.
/// Knows the words that the document uses; an unknown word is itself a fault.
[[nodiscard]] std::vector<std::string> schema_faults(const nlohmann::json& value,
                                                     const nlohmann::json& schema,
                                                     const nlohmann::json& document);

/// The same against components/schemas/NAME.
[[nodiscard]] std::vector<std::string> component_faults(const nlohmann::json& value,
                                                        const std::string& name,
                                                        const nlohmann::json& document);

}  // namespace lpf::test
