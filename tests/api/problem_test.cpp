#include "api/problem.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

namespace lpf {
namespace {

constexpr int kErrorCodes = static_cast<int>(ErrorCode::Internal) + 1;
constexpr int kProblemCodes = static_cast<int>(ProblemCode::UndecodableFile) + 1;

TEST(Problem, TableHasOneRowForEveryProblem) {
    ASSERT_EQ(problem_table().size(), static_cast<std::size_t>(kProblemCodes));
    for (int i = 0; i < kProblemCodes; ++i) {
        EXPECT_EQ(kind_of(static_cast<ProblemCode>(i)).problem, static_cast<ProblemCode>(i)) << i;
    }
}

TEST(Problem, CodesAreUniqueKebabCaseWithAnErrorStatusAndATitle) {
    const std::regex kebab("[a-z]+(-[a-z]+)*");
    std::set<std::string_view> codes;
    for (const ProblemKind& kind : problem_table()) {
        EXPECT_TRUE(codes.insert(kind.code).second) << kind.code;
        EXPECT_TRUE(std::regex_match(std::string(kind.code), kebab)) << kind.code;
        EXPECT_GE(kind.status, 400) << kind.code;
        EXPECT_LT(kind.status, 600) << kind.code;
        EXPECT_FALSE(kind.title.empty()) << kind.code;
    }
}

TEST(Problem, EveryErrorOfTheMethodHasAProblemOfItsOwn) {
    std::set<ProblemCode> seen;
    for (int i = 0; i < kErrorCodes; ++i) seen.insert(problem_code(static_cast<ErrorCode>(i)));
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(kErrorCodes));
}

TEST(Problem, FaultsOfTheClientNeverBecomeServerErrors) {
    for (const ErrorCode code :
         {ErrorCode::InvalidParameter, ErrorCode::TooFewPoints, ErrorCode::DegenerateShape,
          ErrorCode::IncompatibleDictionary, ErrorCode::MalformedFile, ErrorCode::UnsupportedFormat,
          ErrorCode::LimitExceeded}) {
        EXPECT_LT(problem_from(Error(code, "x")).status(), 500);
    }
}

TEST(Problem, StatusesOfTheContractHold) {
    const std::pair<ProblemCode, int> expected[] = {
        {ProblemCode::MalformedJson, 400},       {ProblemCode::Unauthorized, 401},
        {ProblemCode::ResultNotReady, 404},      {ProblemCode::JobDismissed, 410},
        {ProblemCode::JobExpired, 410},          {ProblemCode::LengthRequired, 411},
        {ProblemCode::PayloadTooLarge, 413},     {ProblemCode::UnsupportedMediaType, 415},
        {ProblemCode::RangeNotSatisfiable, 416}, {ProblemCode::InvalidParameter, 422},
        {ProblemCode::RateLimited, 429},         {ProblemCode::QueueFull, 503},
        {ProblemCode::InsufficientStorage, 507}};
    for (const auto& [problem, status] : expected) EXPECT_EQ(kind_of(problem).status, status);
}

TEST(Problem, FieldOfAnErrorBecomesAPointerInTheNamesOfTheWire) {
    const Problem problem =
        problem_from(Error(ErrorCode::InvalidParameter, "too many", "pattern_points"));
    ASSERT_EQ(problem.errors.size(), 1U);
    EXPECT_EQ(problem.errors[0], (FieldError{"/inputs/patternPoints", "too many"}));
}

TEST(Problem, TextOfADefectIsNotShown) {
    const nlohmann::json json =
        to_json(problem_from(Error(ErrorCode::Internal, "secret at 0xdeadbeef")));
    EXPECT_EQ(json.dump().find("secret"), std::string::npos);
    EXPECT_EQ(json["status"], 500);
}

TEST(Problem, JsonHasTheMembersOfRfc9457) {
    const nlohmann::json json = to_json(Problem{.problem = ProblemCode::QueueFull,
                                                .detail = "wait",
                                                .instance = "/v1/jobs",
                                                .errors = {{"/inputs/radius", "bad"}},
                                                .retry_after = 5,
                                                .members = {{"limit", std::int64_t{1000}}}});
    const nlohmann::json expected = {
        {"type", "urn:lpf:problem:queue-full"},
        {"title", "The queue is full"},
        {"status", 503},
        {"detail", "wait"},
        {"instance", "/v1/jobs"},
        {"code", "queue-full"},
        {"retryAfter", 5},
        {"limit", 1000},
        {"errors", nlohmann::json::array({{{"pointer", "/inputs/radius"}, {"detail", "bad"}}})}};
    EXPECT_EQ(json, expected);
}

TEST(Problem, OgcProblemsUseOgcTypes) {
    EXPECT_EQ(to_json(Problem{.problem = ProblemCode::JobNotFound})["type"],
              "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/no-such-job");
}

TEST(Problem, ComesBackFromJson) {
    const Problem problem{.problem = ProblemCode::LimitExceeded,
                          .detail = "over",
                          .instance = "/v1/jobs/1",
                          .errors = {{"/a", "b"}},
                          .retry_after = 3,
                          .members = {{"limit", std::int64_t{7}}, {"name", std::string("points")}}};
    EXPECT_EQ(to_json(problem_from_json(to_json(problem))), to_json(problem));
}

TEST(Problem, UnknownStoredCodeBecomesInternal) {
    EXPECT_EQ(problem_from_json({{"code", "of-the-future"}}).problem, ProblemCode::Internal);
}

}  // namespace
}  // namespace lpf
