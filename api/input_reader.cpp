#include "api/input_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/json_text.h"
#include "api/uuid.h"

namespace lpf {
namespace {

constexpr std::size_t kShownCharacters = 60;

/// A user's value as it is repeated in a message: short, and valid UTF-8 whatever it was.
std::string shown_value(const nlohmann::json& value) {
    std::string text = dump_json(value);
    if (text.size() <= kShownCharacters) return text;
    std::size_t end = kShownCharacters;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

std::string number_text(double value) { return nlohmann::json(value).dump(); }

std::string bound_text(double value) {
    if (std::abs(value) < 1e15 && value == std::floor(value)) {
        return std::to_string(static_cast<std::int64_t>(value));
    }
    return number_text(value);
}

std::string join(const std::vector<std::string_view>& names) {
    std::string text;
    for (const std::string_view name : names) {
        if (!text.empty()) text += ", ";
        text += name;
    }
    return text;
}

bool in_range(const Parameter& parameter, double value) {
    if (!std::isfinite(value) || value > parameter.maximum) return false;
    return parameter.exclusive_minimum ? value > parameter.minimum : value >= parameter.minimum;
}

bool takes(const Parameter& parameter, Task task) {
    return std::ranges::find(parameter.tasks, task) != parameter.tasks.end();
}

}  // namespace

std::string pointer_step(std::string_view name) {
    std::string step = "/";
    for (const char c : name) {
        if (c == '~')
            step += "~0";
        else if (c == '/')
            step += "~1";
        else
            step += c;
    }
    return step;
}

std::string expectation(const Parameter& parameter) {
    if (parameter.type == ParameterType::Choice) return "one of " + join(parameter.choices);
    if (parameter.type == ParameterType::Identifier) return "an ID such as the service gives";
    const std::string what = parameter.type == ParameterType::Integer ? "an integer" : "a number";
    const std::string low = bound_text(parameter.minimum);
    if (parameter.exclusive_minimum && parameter.maximum == kNoMaximum)
        return what + " above " + low;
    if (parameter.maximum == kNoMaximum) return what + " of at least " + low;
    const std::string high = bound_text(parameter.maximum);
    if (parameter.exclusive_minimum) return what + " above " + low + " and at most " + high;
    return what + " from " + low + " to " + high;
}

InputReader::InputReader(Task task, const Limits& limits, std::string pointer)
    : task_(task), pointer_(std::move(pointer)), all_(parameter_table(limits)) {}

void InputReader::read(std::string_view name, const nlohmann::json& value) {
    const Parameter* parameter = find(name);
    if (!parameter || value == "auto") return;
    const bool numeric =
        parameter->type == ParameterType::Number || parameter->type == ParameterType::Integer;
    if (numeric && value.is_number()) {
        keep_number(*parameter, value.get<double>(), shown_value(value));
    } else if (!numeric && value.is_string()) {
        keep_text(*parameter, value.get_ref<const std::string&>());
    } else {
        wrong(*parameter, shown_value(value));
    }
}

void InputReader::read_text(std::string_view name, std::string_view text) {
    const Parameter* parameter = find(name);
    if (!parameter || text == "auto") return;
    if (parameter->type == ParameterType::Choice || parameter->type == ParameterType::Identifier) {
        keep_text(*parameter, text);
        return;
    }
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end || text.empty()) {
        wrong(*parameter, shown_value(text));
    } else {
        keep_number(*parameter, value, shown_value(text));
    }
}

void InputReader::fault(std::string_view name, std::string detail) {
    faults_.push_back({name.empty() ? pointer_ : pointer_ + pointer_step(name), std::move(detail)});
}

JobInputs InputReader::finish() {
    if (faults_.empty()) check_together();
    if (faults_.empty()) return inputs_;
    std::string detail = faults_.front().detail;
    if (faults_.size() > 1) {
        detail += " (and " + std::to_string(faults_.size() - 1) + " more, see errors)";
    }
    throw ProblemException(Problem{
        .problem = ProblemCode::InvalidParameter, .detail = std::move(detail), .errors = faults_});
}

const Parameter* InputReader::find(std::string_view name) {
    const auto row = std::ranges::find(all_, name, &Parameter::name);
    if (row != all_.end() && takes(*row, task_)) return &*row;
    std::string detail =
        shown_value(name) + " is not an input of " + std::string(process_id(task_));
    if (row != all_.end()) {
        detail += ", only of " + std::string(process_id(row->tasks.front()));
    } else {
        std::vector<std::string_view> names;
        for (const Parameter& parameter : all_) {
            if (takes(parameter, task_)) names.push_back(parameter.name);
        }
        detail += ", which takes " + join(names);
    }
    fault(name, detail + ".");
    return nullptr;
}

void InputReader::keep_number(const Parameter& parameter, double value, std::string_view shown) {
    const bool integer = parameter.type == ParameterType::Integer;
    if (!in_range(parameter, value) || (integer && value != std::floor(value))) {
        wrong(parameter, shown);
    } else if (integer) {
        binding_of(parameter.name).set(inputs_, static_cast<std::int64_t>(value));
    } else {
        binding_of(parameter.name).set(inputs_, value);
    }
}

void InputReader::keep_text(const Parameter& parameter, std::string_view text) {
    const bool known = parameter.type == ParameterType::Identifier
                           ? is_uuid7(text)
                           : std::ranges::find(parameter.choices, text) != parameter.choices.end();
    if (known) {
        binding_of(parameter.name).set(inputs_, std::string(text));
    } else {
        wrong(parameter, shown_value(text));
    }
}

void InputReader::wrong(const Parameter& parameter, std::string_view shown) {
    fault(parameter.name, std::string(parameter.name) + " must be " + expectation(parameter) +
                              ", or \"auto\"; it is " + std::string(shown) + ".");
}

void InputReader::check_together() {
    std::vector<std::string_view> targets;
    if (inputs_.target_spacing) targets.push_back("targetSpacing");
    if (inputs_.target_points) targets.push_back("targetPoints");
    if (inputs_.factor) targets.push_back("factor");
    if (targets.size() > 1) {
        for (const std::string_view name : targets) {
            fault(name, "Only one of " + join(targets) + " may be given.");
        }
    }
    if (inputs_.dictionary_mode == DictionaryMode::Fixed && !inputs_.dictionary) {
        fault("dictionaryMode", "fixed needs a dictionary: give its ID as `dictionary`.");
    }
}

}  // namespace lpf
