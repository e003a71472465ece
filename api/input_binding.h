#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "api/job_inputs.h"

namespace lpf {

/// A value of an input as it stands on the wire: a choice is its name.
using InputValue = std::variant<double, std::int64_t, std::string>;

/// Where the value of a parameter lies in JobInputs.
struct InputBinding {
    std::string_view name;
    std::optional<InputValue> (*get)(const JobInputs& inputs);
    void (*set)(JobInputs& inputs, const InputValue& value);
};

/// One row per parameter. A test holds it and `parameter_table` together.
[[nodiscard]] std::span<const InputBinding> input_bindings();

/// @pre there is one of this name
[[nodiscard]] const InputBinding& binding_of(std::string_view name);

}  // namespace lpf
