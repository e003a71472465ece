#include "api/job_inputs.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "api/problem.h"
#include "tests/api/samples.h"

namespace lpf {
namespace {

using nlohmann::json;
using test::kDictionaryId;
using test::kShapeId;
using Query = std::multimap<std::string, std::string>;

/// Pointers of the faults that a reader finds.
template <typename Read>
std::vector<std::string> faults(const Read& read) {
    try {
        (void)read();
    } catch (const ProblemException& refused) {
        EXPECT_EQ(refused.problem().problem, ProblemCode::InvalidParameter);
        std::vector<std::string> pointers;
        for (const FieldError& error : refused.problem().errors) pointers.push_back(error.pointer);
        return pointers;
    }
    return {};
}

std::vector<std::string> json_faults(Task task, const json& inputs) {
    return faults([&] { return inputs_from_json(task, inputs, Limits{}); });
}

std::vector<std::string> query_faults(Task task, const Query& query) {
    return faults([&] { return inputs_from_query(task, query, Limits{}); });
}

using Pointers = std::vector<std::string>;

TEST(InputsFromJson, NothingIsAllAuto) {
    EXPECT_EQ(inputs_from_json(Task::Denoise, json::object(), Limits{}), JobInputs{});
}

TEST(InputsFromJson, AutoIsTheSameAsNothing) {
    EXPECT_EQ(inputs_from_json(Task::Denoise,
                               {{"radius", "auto"}, {"format", "auto"}, {"dictionary", "auto"}},
                               Limits{}),
              JobInputs{});
}

TEST(InputsFromJson, ReadsEveryKindOfValue) {
    const JobInputs inputs = inputs_from_json(Task::Denoise,
                                              {{"radius", 1.5},
                                               {"radiusUnit", "spacing"},
                                               {"atoms", 16.0},
                                               {"probing", "nearestPoint"},
                                               {"dictionary", kDictionaryId},
                                               {"dictionaryMode", "fixed"},
                                               {"format", "drc"},
                                               {"randomSeed", 9007199254740991}},
                                              Limits{});
    EXPECT_EQ(inputs.radius, 1.5);
    EXPECT_EQ(inputs.radius_unit, RadiusUnit::Spacing);
    EXPECT_EQ(inputs.atoms, 16);
    EXPECT_EQ(inputs.probing, ProbingKind::NearestPoint);
    EXPECT_EQ(inputs.dictionary, kDictionaryId);
    EXPECT_EQ(inputs.dictionary_mode, DictionaryMode::Fixed);
    EXPECT_EQ(inputs.format, FileFormat::Draco);
    EXPECT_EQ(inputs.random_seed, 9007199254740991);
}

TEST(InputsFromJson, EveryFaultIsCollected) {
    EXPECT_EQ(json_faults(Task::Denoise, {{"atoms", 0}, {"format", "stl"}, {"radius", -1}}),
              (Pointers{"/inputs/atoms", "/inputs/format", "/inputs/radius"}));
}

TEST(InputsFromJson, UnknownInputIsAFaultThatPointsAtIt) {
    EXPECT_EQ(json_faults(Task::Denoise, {{"radios", 1}}), Pointers{"/inputs/radios"});
    EXPECT_EQ(json_faults(Task::Denoise, {{"a/b~c", 1}}), Pointers{"/inputs/a~1b~0c"});
    EXPECT_EQ(json_faults(Task::Denoise, {{"", 1}}).size(), 1U);
}

TEST(InputsFromJson, InputOfAnotherProcessIsAFaultThatNamesTheProcess) {
    try {
        (void)inputs_from_json(Task::Denoise, {{"factor", 4}}, Limits{});
        FAIL();
    } catch (const ProblemException& refused) {
        EXPECT_NE(refused.problem().detail.find("resample"), std::string::npos);
    }
}

TEST(InputsFromJson, WrongTypesAreFaults) {
    for (const json& value :
         {json("1.5"), json(true), json(nullptr), json::array(), json("AUTO")}) {
        EXPECT_EQ(json_faults(Task::Denoise, {{"radius", value}}), Pointers{"/inputs/radius"})
            << value;
    }
    EXPECT_EQ(json_faults(Task::Denoise, {{"outliers", 1}}), Pointers{"/inputs/outliers"});
    EXPECT_EQ(json_faults(Task::Denoise, {{"atoms", 1.5}}), Pointers{"/inputs/atoms"});
    EXPECT_EQ(json_faults(Task::Denoise, json::array()), Pointers{"/inputs"});
}

TEST(InputsFromJson, EndsOfRangesHold) {
    EXPECT_TRUE(json_faults(Task::Denoise, {{"patternPoints", 5}, {"lambda", 0}}).empty());
    EXPECT_TRUE(json_faults(Task::Denoise, {{"atoms", 256}, {"maxSeconds", 3600}}).empty());
    for (const json& inputs :
         {json{{"patternPoints", 4}}, json{{"lambda", -0.1}}, json{{"atoms", 257}},
          json{{"maxSeconds", 3601}}, json{{"radius", 0}}, json{{"quantizationBits", 31}},
          json{{"randomSeed", 9007199254740992}}, json{{"gamma", 0}}}) {
        EXPECT_EQ(json_faults(Task::Denoise, inputs).size(), 1U) << inputs;
    }
}

TEST(InputsFromJson, MessageNamesTheRange) {
    try {
        (void)inputs_from_json(Task::Denoise, {{"atoms", 257}}, Limits{});
        FAIL();
    } catch (const ProblemException& refused) {
        EXPECT_EQ(refused.problem().detail,
                  "atoms must be an integer from 1 to 256, or \"auto\"; it is 257.");
    }
}

TEST(InputsFromJson, ValuesInMessagesAreCutAndValid) {
    const std::string wild = std::string(5000, 'x') + "\xFF";
    try {
        (void)inputs_from_json(Task::Denoise, {{"format", wild}}, Limits{});
        FAIL();
    } catch (const ProblemException& refused) {
        EXPECT_LT(refused.problem().detail.size(), 300U);
    }
}

TEST(InputsFromJson, TargetsExcludeEachOther) {
    EXPECT_EQ(json_faults(Task::Resample, {{"factor", 2}, {"targetPoints", 100}}),
              (Pointers{"/inputs/targetPoints", "/inputs/factor"}));
    EXPECT_TRUE(json_faults(Task::Resample, {{"factor", 2}, {"targetPoints", "auto"}}).empty());
}

TEST(InputsFromJson, FixedModeNeedsADictionary) {
    EXPECT_EQ(json_faults(Task::Analyze, {{"dictionaryMode", "fixed"}}),
              Pointers{"/inputs/dictionaryMode"});
}

TEST(InputsFromQuery, NumbersComeAsText) {
    const JobInputs inputs = inputs_from_query(
        Task::Resample, {{"factor", "4"}, {"atoms", "1e1"}, {"radius", "auto"}}, Limits{});
    EXPECT_EQ(inputs.factor, 4.0);
    EXPECT_EQ(inputs.atoms, 10);
    EXPECT_FALSE(inputs.radius);
}

TEST(InputsFromQuery, TextThatIsNoNumberIsAFault) {
    for (const char* text : {"", " 1", "1 ", "+1", "1,5", "0x10", "nan", "inf", "1e999", "4m"}) {
        EXPECT_EQ(query_faults(Task::Denoise, {{"radius", text}}), Pointers{"/inputs/radius"})
            << text;
    }
}

TEST(InputsFromQuery, NameGivenTwiceIsAFault) {
    EXPECT_EQ(query_faults(Task::Denoise, {{"radius", "1"}, {"radius", "2"}, {"x", "1"}}),
              (Pointers{"/inputs/radius", "/inputs/x"}));
}

TEST(ExecuteRequest, TakesAnIdOrALink) {
    for (const json& shape : {json(kShapeId), json{{"href", "/v1/shapes/" + kShapeId}}}) {
        const ExecuteRequest request = execute_request_from_json(
            Task::Denoise, {{"inputs", {{"shape", shape}, {"atoms", 3}}}}, Limits{});
        EXPECT_EQ(request.shape, kShapeId);
        EXPECT_EQ(request.inputs.atoms, 3);
    }
}

TEST(ExecuteRequest, RefusesOtherShapesAndPointsAtThem) {
    for (const json& shape :
         {json(nullptr), json("x"), json(3), json{{"href", "http://elsewhere/" + kShapeId}},
          json{{"href", "/v1/shapes/../jobs"}}, json{{"href", 3}},
          json{{"href", "/v1/shapes/" + kShapeId}, {"more", 1}}}) {
        const auto found = faults([&] {
            return execute_request_from_json(Task::Denoise, {{"inputs", {{"shape", shape}}}},
                                             Limits{});
        });
        EXPECT_EQ(found, Pointers{"/inputs/shape"}) << shape;
    }
}

TEST(ExecuteRequest, RefusesOtherBodies) {
    const auto pointers = [](const json& body) {
        return faults([&] { return execute_request_from_json(Task::Denoise, body, Limits{}); });
    };
    EXPECT_EQ(pointers(json::array()), Pointers{""});
    EXPECT_EQ(pointers(json::object()), Pointers{"/inputs"});
    EXPECT_EQ(pointers({{"inputs", 3}}), Pointers{"/inputs"});
    EXPECT_EQ(pointers({{"inputs", json::object()}, {"extra", 1}}), Pointers{"/extra"});
    EXPECT_EQ(pointers({{"inputs", {{"x", 1}}}}), (Pointers{"/inputs/shape", "/inputs/x"}));
}

TEST(JobInputs, ComeBackFromJsonForEveryProcess) {
    JobInputs inputs;
    inputs.radius = 0.1;
    inputs.radius_unit = RadiusUnit::Diagonal;
    inputs.pattern_points = 193;
    inputs.lambda = 0.05;
    inputs.outliers = OutlierPolicy::Remove;
    inputs.dictionary = kDictionaryId;
    inputs.probing = ProbingKind::NearestTriangle;
    inputs.max_seconds = 1.5;
    for (const Task task : {Task::Denoise, Task::Resample, Task::Analyze}) {
        EXPECT_EQ(stored_inputs_from_json(to_json(task, inputs)), inputs);
    }
}

TEST(JobInputs, ShowAutoForWhatWasNotAsked) {
    const json shown = to_json(Task::Analyze, JobInputs{.radius = 2.0});
    EXPECT_EQ(shown["radius"], 2.0);
    EXPECT_EQ(shown["atoms"], "auto");
    EXPECT_FALSE(shown.contains("gamma"));
}

TEST(ToRequest, RadiusIsBroughtToTheUnitOfTheFile) {
    const Measurements measured{.diagonal = 50.0, .mean_spacing = 0.25};
    JobInputs inputs{.radius = 2.0};
    EXPECT_EQ(to_request(inputs, measured).radius, 2.0);
    inputs.radius_unit = RadiusUnit::Spacing;
    EXPECT_EQ(to_request(inputs, measured).radius, 0.5);
    inputs.radius_unit = RadiusUnit::Diagonal;
    EXPECT_EQ(to_request(inputs, measured).radius, 100.0);
    EXPECT_FALSE(to_request(JobInputs{}, measured).radius);
}

TEST(ToRequest, CarriesEverythingTheMethodTakes) {
    const JobInputs inputs = inputs_from_json(Task::Denoise,
                                              {{"patternPoints", 193},
                                               {"atoms", 7},
                                               {"lambda", 0.3},
                                               {"analysisIterations", 4},
                                               {"denoiseIterations", 2},
                                               {"gamma", 1},
                                               {"randomSeed", 99},
                                               {"probing", "orthogonal"},
                                               {"dictionary", kDictionaryId},
                                               {"dictionaryMode", "fixed"}},
                                              Limits{});
    const ParameterRequest request = to_request(inputs, {});
    EXPECT_EQ(request.pattern_points, 193);
    EXPECT_EQ(request.atoms, 7);
    EXPECT_EQ(request.lambda, 0.3);
    EXPECT_EQ(request.analysis_iterations, 4);
    EXPECT_EQ(request.denoise_iterations, 2);
    EXPECT_EQ(request.gamma, 1.0);
    EXPECT_EQ(request.random_seed, 99U);
    EXPECT_EQ(request.probing, ProbingKind::AsOrthogonalAsPossible);
    EXPECT_TRUE(request.keep_dictionary);
    const ParameterRequest targets =
        to_request(JobInputs{.target_spacing = 0.5, .target_points = 10, .factor = 3.0}, {});
    EXPECT_EQ(targets.target_spacing, 0.5);
    EXPECT_EQ(targets.target_points, 10U);
    EXPECT_EQ(targets.factor, 3.0);
    EXPECT_EQ(to_request({}, {}).random_seed, 1U);
}

TEST(CheckResultSize, RefusesAFactorOverTheLimit) {
    const Limits limits{.points = 1000};
    EXPECT_NO_THROW(check_result_size({.factor = 10.0}, 100, limits));
    EXPECT_NO_THROW(check_result_size({}, 5000, limits));
    EXPECT_THROW(check_result_size({.factor = 10.1}, 100, limits), Error);
}

TEST(QuantizationBits, MakeAStepSmallerThanAHundredthOfTheSpacing) {
    for (const double spacing : {0.5, 0.1, 0.01, 0.001}) {
        const int bits = automatic_quantization_bits(10.0, spacing);
        EXPECT_LE(10.0 / std::pow(2.0, bits), spacing / 100.0);
    }
    EXPECT_EQ(automatic_quantization_bits(10.0, 10.0), 11);
    EXPECT_EQ(automatic_quantization_bits(1.0, 1e-9), 24);
    EXPECT_EQ(automatic_quantization_bits(0.0, 0.0), 24);
}

}  // namespace
}  // namespace lpf
