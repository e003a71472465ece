#include "api/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/choices.h"
#include "api/uuid.h"

namespace lpf {
namespace {

constexpr std::array kTasks{Task::Denoise, Task::Resample, Task::Analyze};

const std::vector<Task> kEvery(kTasks.begin(), kTasks.end());
const std::vector<Task> kWithPoints{Task::Denoise, Task::Resample};
const std::vector<Task> kDenoise{Task::Denoise};
const std::vector<Task> kResample{Task::Resample};

constexpr double kLargestExactInteger = 9007199254740991.0;  // 2^53 - 1

using Rows = std::vector<Parameter>;

void add_field_parameters(Rows& rows, const Limits& limits) {
    rows.push_back({.name = "radius",
                    .title = "Radius r of the local probing fields",
                    .unit = "radiusUnit",
                    .exclusive_minimum = true,
                    .tasks = kEvery,
                    .description = "How far one field looks around its seed. Larger takes out "
                                   "more noise and more detail.",
                    .automatic = "is the radius that holds about 150 points, or three times the "
                                 "measured noise if that is more"});
    rows.push_back({.name = "radiusUnit",
                    .type = ParameterType::Choice,
                    .title = "Unit of the radius",
                    .choices = choice_names<RadiusUnit>(),
                    .tasks = kEvery,
                    .description = "absolute: the unit of the file. spacing: multiples of the "
                                   "mean distance of neighbouring points. diagonal: shares of "
                                   "the bounding box's diagonal.",
                    .automatic = "is absolute"});
    rows.push_back({.name = "patternPoints",
                    .type = ParameterType::Integer,
                    .title = "Points M of the sampling pattern",
                    .unit = "points",
                    .minimum = 5,
                    .maximum = static_cast<double>(limits.pattern_points),
                    .tasks = kEvery,
                    .description = "The pattern is the regular grid in a disk whose number of "
                                   "points is nearest to this.",
                    .automatic = "is 193, and 793 for meshes, whose edges are sharp; with a "
                                 "dictionary, it is that of the dictionary"});
    rows.push_back({.name = "probing",
                    .type = ParameterType::Choice,
                    .title = "How a pattern point finds the shape",
                    .choices = choice_names<ProbingKind>(),
                    .tasks = kEvery,
                    .description = "orthogonal: the point nearest in the pattern's plane. "
                                   "noiseAware: the local mean height over the plane. "
                                   "nearestPoint: the nearest point in space. nearestTriangle: "
                                   "the nearest point of a mesh.",
                    .automatic = "is nearestTriangle for meshes that are not denoised, else "
                                 "noiseAware"});
}

void add_dictionary_parameters(Rows& rows, const Limits& limits) {
    rows.push_back({.name = "atoms",
                    .type = ParameterType::Integer,
                    .title = "Atoms d of the dictionary",
                    .unit = "atoms",
                    .minimum = 1,
                    .maximum = static_cast<double>(limits.atoms),
                    .tasks = kEvery,
                    .description = "How many local shapes are learned.",
                    .automatic = "is 16; with a dictionary, it is that of the dictionary"});
    rows.push_back({.name = "lambda",
                    .title = "Weight of sparsity",
                    .minimum = 0,
                    .tasks = kEvery,
                    .description = "Of |V - D a|^2 + lambda |a|_1, for fields in units of the "
                                   "radius. Larger: fewer atoms a field, smoother result.",
                    .automatic = "follows the measured noise and the density of the points"});
    rows.push_back({.name = "analysisIterations",
                    .type = ParameterType::Integer,
                    .title = "Iterations of the joint analysis",
                    .unit = "iterations",
                    .minimum = 1,
                    .maximum = static_cast<double>(limits.analysis_iterations),
                    .tasks = kEvery,
                    .description = "Rounds of learning the dictionary, fitting the poses and "
                                   "probing anew.",
                    .automatic = "is 1 to denoise, 3 to resample, 10 to analyze"});
    rows.push_back({.name = "dictionary",
                    .type = ParameterType::Identifier,
                    .title = "Dictionary to use",
                    .tasks = kEvery,
                    .description = "ID of a dictionary that an earlier job learned.",
                    .automatic = "learns one from the shape itself"});
    rows.push_back({.name = "dictionaryMode",
                    .type = ParameterType::Choice,
                    .title = "What is done with the given dictionary",
                    .choices = choice_names<DictionaryMode>(),
                    .tasks = kEvery,
                    .description = "start: learning goes on from it. fixed: it is used as it is.",
                    .automatic = "is start"});
}

void add_target_parameters(Rows& rows, const Limits& limits) {
    rows.push_back({.name = "denoiseIterations",
                    .type = ParameterType::Integer,
                    .title = "Outer iterations of denoising",
                    .unit = "iterations",
                    .minimum = 1,
                    .maximum = static_cast<double>(limits.denoise_iterations),
                    .tasks = kDenoise,
                    .description = "At most; it stops earlier once the points hardly move.",
                    .automatic = "is 1: one removes the noise"});
    rows.push_back({.name = "gamma",
                    .title = "Step of a point towards the consensus",
                    .exclusive_minimum = true,
                    .tasks = kDenoise,
                    .description = "A point q moves to (q + gamma q') / (1 + gamma), q' being "
                                   "the consensus: 1 goes half the way.",
                    .automatic = "goes the full way"});
    rows.push_back({.name = "targetSpacing",
                    .title = "Least distance of two points of the result",
                    .unit = "length of the file",
                    .exclusive_minimum = true,
                    .tasks = kResample,
                    .description = "Only one of targetSpacing, targetPoints and factor.",
                    .automatic = "follows targetPoints or factor; without them there are as many "
                                 "points as in the input"});
    rows.push_back({.name = "targetPoints",
                    .type = ParameterType::Integer,
                    .title = "Number of points of the result",
                    .unit = "points",
                    .minimum = 1,
                    .maximum = static_cast<double>(limits.points),
                    .tasks = kResample,
                    .description = "Met within a few per cent. Only one of targetSpacing, "
                                   "targetPoints and factor.",
                    .automatic = "follows targetSpacing or factor"});
    rows.push_back({.name = "factor",
                    .title = "Points of the result as a multiple of the input's",
                    .exclusive_minimum = true,
                    .tasks = kResample,
                    .description = "Only one of targetSpacing, targetPoints and factor.",
                    .automatic = "follows targetSpacing or targetPoints"});
}

void add_treatment_parameters(Rows& rows) {
    rows.push_back({.name = "outliers",
                    .type = ParameterType::Choice,
                    .title = "What is done with isolated points",
                    .choices = choice_names<OutlierPolicy>(),
                    .tasks = kEvery,
                    .description = "keep: nothing. mark: the result gets the attribute "
                                   "`outlier`, 0 or 1. remove: they are left out of the work "
                                   "and of the result.",
                    .automatic = "is keep"});
    rows.push_back({.name = "duplicates",
                    .type = ParameterType::Choice,
                    .title = "What is done with points at the same place",
                    .choices = choice_names<DuplicatePolicy>(),
                    .tasks = kEvery,
                    .description = "remove: of points at exactly one place the first stays.",
                    .automatic = "is keep"});
    rows.push_back({.name = "attributes",
                    .type = ParameterType::Choice,
                    .title = "What is done with the attributes of points",
                    .choices = choice_names<AttributePolicy>(),
                    .tasks = kWithPoints,
                    .description = "keep: colour, intensity and all others stay with their "
                                   "point; a resampled point gets those of the nearest one.",
                    .automatic = "is keep"});
    rows.push_back({.name = "normals",
                    .type = ParameterType::Choice,
                    .title = "What is done with normals",
                    .choices = choice_names<NormalPolicy>(),
                    .tasks = kWithPoints,
                    .description = "keep: as the other attributes. estimate: anew from the "
                                   "result. drop: none.",
                    .automatic = "is keep"});
}

void add_run_parameters(Rows& rows, const Limits& limits) {
    rows.push_back({.name = "format",
                    .type = ParameterType::Choice,
                    .title = "File format of the points",
                    .choices = choice_names<FileFormat>(),
                    .tasks = kWithPoints,
                    .description = "ply: binary. drc: Draco, in the order of the points.",
                    .automatic = "is that of the input; big-endian PLY comes back little-endian"});
    rows.push_back({.name = "quantizationBits",
                    .type = ParameterType::Integer,
                    .title = "Bits of a coordinate in Draco",
                    .unit = "bits",
                    .minimum = 0,
                    .maximum = 30,
                    .tasks = kWithPoints,
                    .description = "0: exact float32.",
                    .automatic = "makes a step smaller than a hundredth of the mean spacing"});
    rows.push_back({.name = "randomSeed",
                    .type = ParameterType::Integer,
                    .title = "Seed of the random numbers",
                    .minimum = 0,
                    .maximum = kLargestExactInteger,
                    .tasks = kEvery,
                    .description = "The same seed and inputs give the same result.",
                    .automatic = "is 1"});
    rows.push_back({.name = "maxSeconds",
                    .title = "Time that the job may run",
                    .unit = "s",
                    .maximum = static_cast<double>(limits.job_seconds),
                    .exclusive_minimum = true,
                    .tasks = kEvery,
                    .description = "A job that runs longer fails with `timed-out`.",
                    .automatic = "is the limit jobSeconds of the service"});
}

nlohmann::json number_schema(const Parameter& parameter) {
    const bool integer = parameter.type == ParameterType::Integer;
    const auto bound = [&](double value) -> nlohmann::json {
        if (value == std::floor(value)) return static_cast<std::int64_t>(value);
        return value;
    };
    nlohmann::json schema = {{"type", integer ? "integer" : "number"}};
    schema[parameter.exclusive_minimum ? "exclusiveMinimum" : "minimum"] = bound(parameter.minimum);
    if (parameter.maximum != kNoMaximum) schema["maximum"] = bound(parameter.maximum);
    return schema;
}

}  // namespace

std::vector<Parameter> parameter_table(const Limits& limits) {
    Rows rows;
    add_field_parameters(rows, limits);
    add_dictionary_parameters(rows, limits);
    add_target_parameters(rows, limits);
    add_treatment_parameters(rows);
    add_run_parameters(rows, limits);
    return rows;
}

std::vector<Parameter> parameters_of(Task task, const Limits& limits) {
    Rows rows = parameter_table(limits);
    std::erase_if(rows, [&](const Parameter& row) {
        return std::ranges::find(row.tasks, task) == row.tasks.end();
    });
    return rows;
}

nlohmann::json parameter_schema(const Parameter& parameter) {
    nlohmann::json schema = {{"title", parameter.title},
                             {"description", parameter.description},
                             {"default", "auto"},
                             {"x-auto", "auto " + std::string(parameter.automatic) + "."}};
    if (!parameter.unit.empty()) schema["x-unit"] = parameter.unit;
    const nlohmann::json automatic = {{"type", "string"}, {"const", "auto"}};
    if (parameter.type == ParameterType::Choice) {
        schema["type"] = "string";
        schema["enum"] = {"auto"};
        for (const std::string_view choice : parameter.choices) schema["enum"].push_back(choice);
    } else if (parameter.type == ParameterType::Identifier) {
        schema["oneOf"] = {automatic, {{"type", "string"}, {"pattern", kUuidPattern}}};
    } else {
        schema["oneOf"] = {automatic, number_schema(parameter)};
    }
    return schema;
}

std::string_view process_id(Task task) {
    switch (task) {
        case Task::Denoise: return "denoise";
        case Task::Resample: return "resample";
        case Task::Analyze: return "analyze";
    }
    return "";
}

std::optional<Task> task_from_id(std::string_view process_id_text) {
    for (const Task task : kTasks) {
        if (process_id(task) == process_id_text) return task;
    }
    return std::nullopt;
}

std::span<const Task> all_tasks() { return kTasks; }

}  // namespace lpf
