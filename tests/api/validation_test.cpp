#include "api/validation.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "api/openapi.h"
#include "tests/api/samples.h"
#include "tests/api/schema_checker.h"

namespace lpf {
namespace {

using nlohmann::json;

/// A job that there is nothing to say against.
Validation fine() {
    Validation v;
    v.format = "ply";
    v.points = 10'000;
    v.measurements = {.points = 10'000,
                      .diagonal = 2.0,
                      .mean_spacing = 0.01,
                      .noise = 0.001,
                      .density_radius = 0.1};
    v.neighbours = {0.06, {20, 40, 50, 60}};
    v.resolved_parameters = {{"atoms", 16.0, true, "rule"}, {"radius", 0.06, true, "rule"}};
    v.work.fields = 1500;
    v.work.output_points = 10'000;
    v.estimate = {.seconds = 2, .memory_bytes = 3e7};
    return v;
}

std::vector<std::string> codes(const Validation& v, const OddPoints& odd = {},
                               const std::vector<std::string>& rules = {}) {
    std::vector<std::string> result;
    for (const Warning& warning : foresee(v, odd, rules, {100, 1e9}))
        result.push_back(warning.code);
    return result;
}

using Codes = std::vector<std::string>;

TEST(Validation, WarnsOfNothingWhereAllIsWell) { EXPECT_EQ(codes(fine()), Codes{}); }

TEST(Validation, WarnsOfARadiusThatDoesNotFit) {
    Validation v = fine();
    v.neighbours.counts = {0, 0, 1, 9};
    EXPECT_EQ(codes(v), Codes{"radius-too-small"});
    v = fine();
    v.neighbours.radius = 0.6;
    EXPECT_EQ(codes(v), Codes{"radius-too-large"});
}

TEST(Validation, PassesOnWhatTheRulesSayUnlessItSaysSoItself) {
    EXPECT_EQ(codes(fine(), {}, {"a rule"}), Codes{"parameters"});
    Validation v = fine();
    v.neighbours.radius = 0.6;
    EXPECT_EQ(codes(v, {}, {"the same in other words"}), Codes{"radius-too-large"});
}

TEST(Validation, WarnsOfFewPointsAndFields) {
    Validation v = fine();
    v.points = 400;
    v.work.fields = 60;
    EXPECT_EQ(codes(v), (Codes{"few-points", "few-fields"}));
}

TEST(Validation, WarnsOfOddPointsUnlessTheyAreDealtWith) {
    const OddPoints odd{.duplicates = 900, .outliers = 30};
    Validation v = fine();
    EXPECT_EQ(codes(v, odd), (Codes{"duplicate-points", "outliers"}));
    v.parameters.duplicates = DuplicatePolicy::Remove;
    v.parameters.outliers = OutlierPolicy::Mark;
    EXPECT_EQ(codes(v, odd), Codes{});
    EXPECT_EQ(codes(fine(), {.duplicates = 3, .outliers = 1}), Codes{});
}

TEST(Validation, WarnsOfInputsWithoutEffect) {
    Validation v = fine();
    v.parameters.normals = NormalPolicy::Keep;
    v.parameters.radius_unit = RadiusUnit::Spacing;
    v.parameters.dictionary_mode = DictionaryMode::Fixed;
    EXPECT_EQ(codes(v), (Codes{"no-normals", "unused-input", "unused-input"}));
    EXPECT_EQ(codes(v, {.has_normals = true}), (Codes{"unused-input", "unused-input"}));
}

TEST(Validation, WarnsOfAJobThatMayNotTakeSoLong) {
    Validation v = fine();
    v.estimate.seconds = 101;
    EXPECT_EQ(codes(v), Codes{"too-long"});
}

TEST(Validation, WarnsOfAJobThatWouldBeRefusedForItsMemory) {
    Validation v = fine();
    v.estimate.memory_bytes = 1e9 + 1;
    EXPECT_EQ(codes(v), Codes{"too-large"});
}

TEST(Validation, CountsNeighboursInBinsThatDouble) {
    Validation v = fine();
    v.neighbours.counts = {0, 1, 1, 2, 3, 5, 8, 8};
    const json neighbours = to_json(v)["neighbours"];
    EXPECT_EQ(neighbours["median"], 3);
    double sum = 0;
    for (const json& bin : neighbours["histogram"]) sum += bin["share"].get<double>();
    EXPECT_DOUBLE_EQ(sum, 1.0);
    EXPECT_EQ(neighbours["histogram"][1], (json{{"from", 1}, {"to", 1}, {"share", 0.25}}));
    EXPECT_EQ(neighbours["histogram"].back()["to"], 15);
    EXPECT_EQ(NeighbourCounts{}.quantile(0.5), 0U);
}

TEST(Validation, FollowsItsSchema) {
    const json document = openapi_document(Limits{}, "1", "/");
    for (const Task task : {Task::Denoise, Task::Resample, Task::Analyze}) {
        Validation v = fine();
        v.process = task;
        v.work.task = task;
        v.attributes = {{"red", "vertex", Fate::Kept, "as it is"}};
        for (const std::string& fault : test::component_faults(to_json(v), "Validation", document))
            ADD_FAILURE() << fault;
        v.shape = test::kShapeId;
        EXPECT_TRUE(test::component_faults(to_json(v), "Validation", document).empty());
    }
}

}  // namespace
}  // namespace lpf
