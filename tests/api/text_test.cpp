#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "api/camel_case.h"
#include "api/json_text.h"
#include "api/problem.h"
#include "api/time_text.h"
#include "api/uuid.h"

namespace lpf {
namespace {

ProblemCode refusal(std::string_view text, const Limits& limits = {}) {
    try {
        (void)parse_json(text, limits);
    } catch (const ProblemException& refused) {
        return refused.problem().problem;
    }
    ADD_FAILURE() << "accepted: " << text;
    return ProblemCode::Internal;
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(JsonText, ReadsAnObject) {
    EXPECT_EQ(parse_json(R"({"a": [1, 2.5, "x", null, true]})", {}),
              (nlohmann::json{{"a", {1, 2.5, "x", nullptr, true}}}));
}

TEST(JsonText, SkipsAByteOrderMark) {
    EXPECT_EQ(parse_json("\xEF\xBB\xBF{}", {}), nlohmann::json::object());
}

TEST(JsonText, NamesTheByteOfAFault) {
    try {
        (void)parse_json(R"({"a": 1,})", {});
        FAIL();
    } catch (const ProblemException& refused) {
        EXPECT_EQ(refused.problem().problem, ProblemCode::MalformedJson);
        EXPECT_NE(refused.problem().detail.find("byte 9"), std::string::npos)
            << refused.problem().detail;
    }
}

TEST(JsonText, RefusesWhatIsNotJson) {
    for (const char* text : {"", " ", "{", "nul", "{'a':1}", "[1] 2", "NaN", "\x01", "\"\xFF\""}) {
        EXPECT_EQ(refusal(text), ProblemCode::MalformedJson) << text;
    }
}

TEST(JsonText, RefusesNumbersThatOverflow) {
    EXPECT_EQ(refusal("[1e999]"), ProblemCode::MalformedJson);
}

TEST(JsonText, DepthIsLimited) {
    const Limits limits;
    EXPECT_NO_THROW((void)parse_json(nested(limits.json_depth), limits));
    EXPECT_EQ(refusal(nested(limits.json_depth + 1), limits), ProblemCode::LimitExceeded);
    EXPECT_EQ(refusal(std::string(500'000, '['), limits), ProblemCode::LimitExceeded);
}

TEST(JsonText, SizeIsLimited) {
    const Limits limits{.json_bytes = 10};
    EXPECT_NO_THROW((void)parse_json("\"12345678\"", limits));
    EXPECT_EQ(refusal("\"123456789\"", limits), ProblemCode::PayloadTooLarge);
}

TEST(JsonText, StringsAndNamesAreLimited) {
    const Limits limits{.json_string_bytes = 3};
    EXPECT_NO_THROW((void)parse_json(R"({"abc": "def"})", limits));
    EXPECT_EQ(refusal(R"({"a": "defg"})", limits), ProblemCode::LimitExceeded);
    EXPECT_EQ(refusal(R"({"abcd": 1})", limits), ProblemCode::LimitExceeded);
}

TEST(JsonText, RefusesAKeyTwiceInOneObjectOnly) {
    EXPECT_EQ(refusal(R"({"a": 1, "a": 2})"), ProblemCode::MalformedJson);
    EXPECT_EQ(refusal(R"([{"b": {"a": 1, "a": 2}}])"), ProblemCode::MalformedJson);
    EXPECT_NO_THROW((void)parse_json(R"({"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]})", {}));
}

TEST(JsonText, WritingInvalidUtf8DoesNotThrow) {
    EXPECT_EQ(dump_json(nlohmann::json("a\xFF")), "\"a\xEF\xBF\xBD\"");
}

TEST(Rfc3339, WritesMilliseconds) {
    EXPECT_EQ(to_rfc3339(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(to_rfc3339(1'772'366'400'123), "2026-03-01T12:00:00.123Z");
    EXPECT_EQ(to_rfc3339(-1), "1969-12-31T23:59:59.999Z");
}

TEST(Rfc3339, ComesBack) {
    for (const UnixMillis time : {0LL, -1LL, 951'826'154'321LL, 4'102'444'799'999LL}) {
        EXPECT_EQ(from_rfc3339(to_rfc3339(time)), time);
    }
}

TEST(Rfc3339, ReadsOffsetsAndAnyNumberOfDecimals) {
    EXPECT_EQ(from_rfc3339("1970-01-01T02:00:00+02:00"), 0);
    EXPECT_EQ(from_rfc3339("1969-12-31t22:30:00-01:30"), 0);
    EXPECT_EQ(from_rfc3339("1970-01-01T00:00:00.5Z"), 500);
    EXPECT_EQ(from_rfc3339("1970-01-01T00:00:00.123456789Z"), 123);
}

TEST(Rfc3339, RefusesEverythingElse) {
    for (const char* text :
         {"", "1970-01-01", "1970-01-01T00:00:00", "1970-02-30T00:00:00Z", "1970-13-01T00:00:00Z",
          "1970-01-01T24:00:00Z", "1970-01-01T00:60:00Z", "1970-01-01T00:00:00.Z",
          "1970-01-01T00:00:00Z ", "1970-01-01 00:00:00Z", "70-01-01T00:00:00Z"}) {
        EXPECT_FALSE(from_rfc3339(text)) << text;
    }
}

TEST(Uuid7, HoldsTimeVersionVariantAndRandomBits) {
    const std::string ones =
        make_uuid7(0x0123456789AB, {255, 255, 255, 255, 255, 255, 255, 255, 255, 255});
    EXPECT_EQ(ones, "01234567-89ab-7fff-bfff-ffffffffffff");
    EXPECT_EQ(make_uuid7(0, {}), "00000000-0000-7000-8000-000000000000");
    EXPECT_EQ(uuid7_millis(ones), 0x0123456789AB);
}

TEST(Uuid7, SortsByTimeAsText) {
    EXPECT_LT(make_uuid7(1'772'366'400'000, {255, 255}), make_uuid7(1'772'366'400'001, {}));
}

TEST(Uuid7, IsCheckedStrictly) {
    EXPECT_TRUE(is_uuid7("0198f3a2-7c1e-7d42-9b57-3f1d2a6c8e01"));
    for (const char* text :
         {"", "0198f3a2-7c1e-7d42-9b57-3f1d2a6c8e0", "0198f3a2-7c1e-7d42-9b57-3f1d2a6c8e011",
          "0198F3A2-7C1E-7D42-9B57-3F1D2A6C8E01", "0198f3a2-7c1e-4d42-9b57-3f1d2a6c8e01",
          "0198f3a2-7c1e-7d42-cb57-3f1d2a6c8e01", "0198f3a2-7c1e-7d42-9b57_3f1d2a6c8e01",
          "../../../../../../../etc/passwd/1234", "0198f3a2-7c1e-7d42-9b57-3f1d2a6c8e0g"}) {
        EXPECT_FALSE(is_uuid7(text)) << text;
    }
}

TEST(CamelCase, TurnsNamesOfTheCodeIntoThoseOfTheWire) {
    EXPECT_EQ(camel_case("pattern_points"), "patternPoints");
    EXPECT_EQ(camel_case("analysis_iterations"), "analysisIterations");
    EXPECT_EQ(camel_case("radius"), "radius");
    EXPECT_EQ(camel_case("patternPoints"), "patternPoints");
}

TEST(Limits, EveryFieldHasARowOfItsOwnAndIsWritten) {
    std::set<std::string_view> names;
    for (const LimitField& field : limit_table()) {
        EXPECT_TRUE(names.insert(field.name).second) << field.name;
        Limits limits;
        limits.*field.value = 123'456'789;
        EXPECT_EQ(to_json(limits)[std::string(field.name)], 123'456'789) << field.name;
    }
    EXPECT_EQ(limit_table().size() * sizeof(std::uint64_t), sizeof(Limits));
}

TEST(Limits, DefaultsAreThoseOfTheContract) {
    const nlohmann::json json = to_json(Limits{});
    EXPECT_EQ(json["uploadBytes"], 512ULL << 20);
    EXPECT_EQ(json["points"], 20'000'000);
    EXPECT_EQ(json["faces"], 40'000'000);
    EXPECT_EQ(json["jsonBytes"], 1 << 20);
    EXPECT_EQ(json["jsonDepth"], 32);
    EXPECT_EQ(json["queuedJobs"], 1000);
    EXPECT_EQ(json["jobSeconds"], 3600);
    EXPECT_EQ(json["waitSeconds"], 60);
}

}  // namespace
}  // namespace lpf
