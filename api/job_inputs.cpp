#include "api/job_inputs.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/input_binding.h"
#include "api/input_reader.h"
#include "api/parameters.h"
#include "api/problem.h"
#include "api/uuid.h"

namespace lpf {
namespace {

using nlohmann::json;

constexpr std::string_view kShapePath = "/v1/shapes/";

void read_all(InputReader& reader, const json& inputs) {
    for (const auto& [name, value] : inputs.items()) {
        if (name != "shape") reader.read(name, value);
    }
}

/// The ID in "ID" or {"href": "/v1/shapes/ID"}; empty if it is neither.
std::string shape_id(const json& shape) {
    std::string text;
    if (shape.is_string()) {
        text = shape.get<std::string>();
    } else if (shape.is_object() && shape.size() == 1 && shape.contains("href") &&
               shape["href"].is_string()) {
        text = shape["href"].get<std::string>();
        if (!text.starts_with(kShapePath)) return {};
        text.erase(0, kShapePath.size());
    }
    return is_uuid7(text) ? text : std::string();
}

[[noreturn]] void refuse_body(const std::string& pointer, const std::string& detail) {
    throw ProblemException(Problem{
        .problem = ProblemCode::InvalidParameter, .detail = detail, .errors = {{pointer, detail}}});
}

std::optional<int> as_int(const std::optional<std::int64_t>& value) {
    if (!value) return std::nullopt;
    return static_cast<int>(*value);
}

std::optional<double> absolute_radius(const JobInputs& inputs, const Measurements& measurements) {
    if (!inputs.radius) return std::nullopt;
    switch (inputs.radius_unit.value_or(RadiusUnit::Absolute)) {
        case RadiusUnit::Absolute: return *inputs.radius;
        case RadiusUnit::Spacing: return *inputs.radius * measurements.mean_spacing;
        case RadiusUnit::Diagonal: return *inputs.radius * measurements.diagonal;
    }
    return std::nullopt;
}

}  // namespace

JobInputs inputs_from_json(Task task, const json& inputs, const Limits& limits,
                           const std::string& pointer) {
    InputReader reader(task, limits, pointer);
    if (!inputs.is_object()) {
        reader.fault("", "The inputs must be a JSON object.");
        return reader.finish();
    }
    for (const auto& [name, value] : inputs.items()) reader.read(name, value);
    return reader.finish();
}

JobInputs inputs_from_query(Task task, const std::multimap<std::string, std::string>& query,
                            const Limits& limits) {
    InputReader reader(task, limits, "/inputs");
    for (auto entry = query.begin(); entry != query.end();) {
        const auto& [name, text] = *entry;
        if (query.count(name) > 1) {
            reader.fault(name, "An input may be given once only.");
        } else {
            reader.read_text(name, text);
        }
        entry = query.upper_bound(name);
    }
    return reader.finish();
}

ExecuteRequest execute_request_from_json(Task task, const json& body, const Limits& limits) {
    if (!body.is_object()) refuse_body("", "The body must be a JSON object with a member inputs.");
    for (const auto& [name, value] : body.items()) {
        if (name == "inputs") continue;
        refuse_body(pointer_step(name), "The body takes the member inputs and no other.");
    }
    if (!body.contains("inputs") || !body["inputs"].is_object()) {
        refuse_body("/inputs", "The body needs the member inputs, an object.");
    }
    const json& inputs = body["inputs"];
    InputReader reader(task, limits, "/inputs");
    ExecuteRequest request;
    if (inputs.contains("shape")) request.shape = shape_id(inputs["shape"]);
    if (request.shape.empty()) {
        reader.fault(
            "shape",
            "shape must be the ID of an uploaded shape, or {\"href\": \"/v1/shapes/ID\"}.");
    }
    read_all(reader, inputs);
    request.inputs = reader.finish();
    return request;
}

json to_json(Task task, const JobInputs& inputs) {
    json result = json::object();
    for (const Parameter& parameter : parameters_of(task, Limits{})) {
        const std::string name(parameter.name);
        const auto value = binding_of(parameter.name).get(inputs);
        if (value) {
            std::visit([&](const auto& v) { result[name] = v; }, *value);
        } else {
            result[name] = "auto";
        }
    }
    return result;
}

JobInputs stored_inputs_from_json(const json& stored) {
    JobInputs inputs;
    for (const Parameter& parameter : parameter_table(Limits{})) {
        const auto value = stored.find(std::string(parameter.name));
        if (value == stored.end() || *value == "auto") continue;
        const InputBinding& binding = binding_of(parameter.name);
        const bool text =
            parameter.type == ParameterType::Choice || parameter.type == ParameterType::Identifier;
        if (text && value->is_string()) binding.set(inputs, value->get<std::string>());
        if (text || !value->is_number()) continue;
        if (parameter.type == ParameterType::Integer) {
            binding.set(inputs, value->get<std::int64_t>());
        } else {
            binding.set(inputs, value->get<double>());
        }
    }
    return inputs;
}

ParameterRequest to_request(const JobInputs& inputs, const Measurements& measurements) {
    ParameterRequest request;
    request.radius = absolute_radius(inputs, measurements);
    request.pattern_points = as_int(inputs.pattern_points);
    request.atoms = as_int(inputs.atoms);
    request.lambda = inputs.lambda;
    request.analysis_iterations = as_int(inputs.analysis_iterations);
    request.denoise_iterations = as_int(inputs.denoise_iterations);
    request.gamma = inputs.gamma;
    request.target_spacing = inputs.target_spacing;
    if (inputs.target_points) {
        request.target_points = static_cast<std::size_t>(*inputs.target_points);
    }
    request.factor = inputs.factor;
    request.probing = inputs.probing;
    request.random_seed = static_cast<std::uint64_t>(inputs.random_seed.value_or(1));
    request.keep_dictionary = inputs.dictionary_mode == DictionaryMode::Fixed;
    return request;
}

void check_result_size(const JobInputs& inputs, std::uint64_t input_points, const Limits& limits) {
    if (!inputs.factor) return;
    if (*inputs.factor * static_cast<double>(input_points) <= static_cast<double>(limits.points)) {
        return;
    }
    throw Error(ErrorCode::LimitExceeded,
                "factor asks for more points than the limit points of " +
                    std::to_string(limits.points) + ".",
                "factor");
}

int automatic_quantization_bits(double diagonal, double mean_spacing) {
    constexpr int kFewest = 11;
    constexpr int kMost = 24;  // a float32 coordinate holds no more
    if (!(diagonal > 0.0) || !(mean_spacing > 0.0)) return kMost;
    const double steps = 100.0 * diagonal / mean_spacing;
    return static_cast<int>(
        std::clamp(std::ceil(std::log2(steps)), double{kFewest}, double{kMost}));
}

}  // namespace lpf
