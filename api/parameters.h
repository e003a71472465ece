#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/limits.h"
#include "core/auto_parameters.h"

namespace lpf {

/// What a value is, besides the string "auto".
enum class ParameterType { Number, Integer, Choice, Identifier };

inline constexpr double kNoMaximum = std::numeric_limits<double>::infinity();

/// One input of the processes. Validation, JSON Schema and documentation are all made from this.
struct Parameter {
    std::string_view name;  ///< on the wire, camelCase
    ParameterType type = ParameterType::Number;
    std::string_view title = {};
    std::string_view unit = {};      ///< e.g. "points"; empty if it has none
    double minimum = 0.0;            ///< of numbers
    double maximum = kNoMaximum;     ///< of numbers
    bool exclusive_minimum = false;  ///< the minimum itself is not allowed
    std::vector<std::string_view> choices = {};
    std::vector<Task> tasks = {};  ///< the processes that take it
    std::string_view description = {};
    std::string_view automatic = {};  ///< what "auto", the default, does
};

/// All parameters, in the order of the documentation. Upper ends come from the limits.
[[nodiscard]] std::vector<Parameter> parameter_table(const Limits& limits);

/// The rows that a process takes.
[[nodiscard]] std::vector<Parameter> parameters_of(Task task, const Limits& limits);

/// JSON Schema (draft 2020-12) of one parameter: the number or choice, or "auto".
[[nodiscard]] nlohmann::json parameter_schema(const Parameter& parameter);

/// "denoise", "resample", "analyze".
[[nodiscard]] std::string_view process_id(Task task);
[[nodiscard]] std::optional<Task> task_from_id(std::string_view process_id);
[[nodiscard]] std::span<const Task> all_tasks();

}  // namespace lpf
