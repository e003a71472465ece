#include "api/parameters.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "api/input_binding.h"

namespace lpf {
namespace {

std::set<std::string_view> names_of(Task task) {
    std::set<std::string_view> names;
    for (const Parameter& parameter : parameters_of(task, Limits{})) names.insert(parameter.name);
    return names;
}

nlohmann::json schema_of(std::string_view name, const Limits& limits = {}) {
    for (const Parameter& parameter : parameter_table(limits)) {
        if (parameter.name == name) return parameter_schema(parameter);
    }
    return {};
}

TEST(ParameterTable, AndTheBindingsNameTheSameInputs) {
    std::set<std::string_view> bound;
    for (const InputBinding& binding : input_bindings()) bound.insert(binding.name);
    std::set<std::string_view> listed;
    for (const Parameter& parameter : parameter_table(Limits{})) listed.insert(parameter.name);
    EXPECT_EQ(bound, listed);
    EXPECT_EQ(bound.size(), input_bindings().size());
}

TEST(ParameterTable, EveryRowIsDocumented) {
    for (const Parameter& parameter : parameter_table(Limits{})) {
        EXPECT_FALSE(parameter.title.empty()) << parameter.name;
        EXPECT_FALSE(parameter.description.empty()) << parameter.name;
        EXPECT_FALSE(parameter.automatic.empty()) << parameter.name;
        EXPECT_FALSE(parameter.tasks.empty()) << parameter.name;
        EXPECT_EQ(parameter.type == ParameterType::Choice, !parameter.choices.empty());
    }
}

TEST(ParameterTable, HasEveryInputOfTheContract) {
    const std::set<std::string_view> contract{"radius",
                                              "radiusUnit",
                                              "patternPoints",
                                              "atoms",
                                              "lambda",
                                              "analysisIterations",
                                              "denoiseIterations",
                                              "gamma",
                                              "targetSpacing",
                                              "targetPoints",
                                              "factor",
                                              "outliers",
                                              "duplicates",
                                              "attributes",
                                              "normals",
                                              "dictionary",
                                              "dictionaryMode",
                                              "probing",
                                              "randomSeed",
                                              "format",
                                              "quantizationBits",
                                              "maxSeconds"};
    std::set<std::string_view> all = names_of(Task::Denoise);
    all.merge(names_of(Task::Resample));
    all.merge(names_of(Task::Analyze));
    EXPECT_EQ(all, contract);
}

TEST(ParameterTable, ProcessesTakeOnlyWhatConcernsThem) {
    EXPECT_TRUE(names_of(Task::Denoise).contains("gamma"));
    EXPECT_FALSE(names_of(Task::Denoise).contains("factor"));
    EXPECT_TRUE(names_of(Task::Resample).contains("factor"));
    EXPECT_FALSE(names_of(Task::Resample).contains("denoiseIterations"));
    for (const char* name : {"gamma", "denoiseIterations", "factor", "targetPoints", "format"}) {
        EXPECT_FALSE(names_of(Task::Analyze).contains(name)) << name;
    }
}

TEST(ParameterSchema, NumbersAreAutoOrInRange) {
    const nlohmann::json schema = schema_of("patternPoints", Limits{.pattern_points = 500});
    EXPECT_EQ(schema["default"], "auto");
    EXPECT_EQ(schema["x-unit"], "points");
    EXPECT_EQ(schema["oneOf"],
              (nlohmann::json::array({{{"type", "string"}, {"const", "auto"}},
                                      {{"type", "integer"}, {"minimum", 5}, {"maximum", 500}}})));
}

TEST(ParameterSchema, AnOpenRangeHasNoMaximum) {
    const nlohmann::json number = schema_of("radius")["oneOf"][1];
    EXPECT_EQ(number, (nlohmann::json{{"type", "number"}, {"exclusiveMinimum", 0}}));
}

TEST(ParameterSchema, ChoicesHoldAuto) {
    EXPECT_EQ(schema_of("format")["enum"], (nlohmann::json{"auto", "ply", "ply-ascii", "drc"}));
    EXPECT_EQ(schema_of("radiusUnit")["enum"],
              (nlohmann::json{"auto", "absolute", "spacing", "diagonal"}));
}

TEST(ProcessId, IsReadAndWritten) {
    EXPECT_EQ(all_tasks().size(), 3U);
    for (const Task task : all_tasks()) EXPECT_EQ(task_from_id(process_id(task)), task);
    EXPECT_FALSE(task_from_id("Denoise"));
    EXPECT_FALSE(task_from_id(""));
}

}  // namespace
}  // namespace lpf
