#include "server/site/router.h"

#include <gtest/gtest.h>

#include "api/problem.h"
#include "core/base/error.h"

namespace lpf::server {
namespace {

http::Response text(const std::string& body) {
    http::Response response;
    response.body = body;
    return response;
}

Router example() {
    return Router({{"GET", "/jobs", [](http::Request&) { return text("list"); }},
                   {"GET", "/jobs/{id}",
                    [](http::Request& r) { return text("job " + r.path_parameters.at(0)); }},
                   {"DELETE", "/jobs/{id}", [](http::Request&) { return text("gone"); }},
                   {"GET", "/jobs/{id}/results",
                    [](http::Request& r) { return text("results " + r.path_parameters.at(0)); }},
                   {"GET", "/error",
                    [](http::Request&) -> http::Response {
                        throw Error(ErrorCode::TooFewPoints, "Two points.");
                    }},
                   {"GET", "/defect",
                    [](http::Request&) -> http::Response { throw std::runtime_error("secret"); }}});
}

struct Heard {
    http::Response response;
    http::Request request;
    std::string report;
};

Heard ask(const Router& router, const std::string& method, const std::string& path) {
    Heard heard;
    heard.request.method = method;
    heard.request.path = path;
    heard.response =
        router.handle(heard.request, [&](const std::string& what) { heard.report = what; });
    return heard;
}

TEST(Router, FindsTheRouteAndItsParameters) {
    EXPECT_EQ(ask(example(), "GET", "/jobs").response.body, "list");
    EXPECT_EQ(ask(example(), "GET", "/jobs/7").response.body, "job 7");
    EXPECT_EQ(ask(example(), "GET", "/jobs/7/results").response.body, "results 7");
    EXPECT_EQ(ask(example(), "DELETE", "/jobs/7").response.body, "gone");
}

TEST(Router, LogsThePatternNotThePath) {
    EXPECT_EQ(ask(example(), "GET", "/jobs/7").request.route, "/jobs/{id}");
}

TEST(Router, HeadIsAnsweredByGet) {
    EXPECT_EQ(ask(example(), "HEAD", "/jobs").response.status, 200);
}

TEST(Router, UnknownPathsAre404) {
    for (const char* path : {"/", "/job", "/jobs/", "/jobs/7/", "/jobs//results", "//jobs"})
        EXPECT_EQ(ask(example(), "GET", path).response.status, 404) << path;
}

TEST(Router, WrongMethodsAre405AndTellTheRightOnes) {
    const auto heard = ask(example(), "POST", "/jobs/7");
    EXPECT_EQ(heard.response.status, 405);
    EXPECT_EQ(heard.response.header("Allow"), "DELETE, GET, HEAD, OPTIONS");
}

TEST(Router, OptionsTellsTheMethods) {
    const auto heard = ask(example(), "OPTIONS", "/jobs");
    EXPECT_EQ(heard.response.status, 204);
    EXPECT_EQ(heard.response.header("Allow"), "GET, HEAD, OPTIONS");
}

TEST(Router, ErrorsBecomeProblems) {
    const auto heard = ask(example(), "GET", "/error");
    EXPECT_EQ(heard.response.status, 422);
    EXPECT_NE(heard.response.body.find("too-few-points"), std::string::npos);
    EXPECT_TRUE(heard.report.empty());
}

TEST(Router, DefectsAreReportedButNotShown) {
    const auto heard = ask(example(), "GET", "/defect");
    EXPECT_EQ(heard.response.status, 500);
    EXPECT_EQ(heard.response.body.find("secret"), std::string::npos);
    EXPECT_EQ(heard.report, "secret");
}

TEST(Router, FallbackTakesOnlyGetsThatNothingElseTakes) {
    const Router router({{"POST", "/a", [](http::Request&) { return text("a"); }}},
                        [](http::Request&) { return text("page"); });
    EXPECT_EQ(ask(router, "GET", "/").response.body, "page");
    EXPECT_EQ(ask(router, "GET", "/a").response.status, 405);
    EXPECT_EQ(ask(router, "POST", "/b").response.status, 404);
}

}  // namespace
}  // namespace lpf::server
