#include "server/requests/answer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/store/sha256.h"

namespace lpf::server {
namespace {

http::Request get(http::Fields headers = {}) {
    http::Request request;
    request.method = "GET";
    request.path = "/v1/x";
    request.id = "id-1";
    request.headers = std::move(headers);
    return request;
}

const FileHead kHead{.type = "application/ply", .filename = "a.ply", .sha256 = {}};

TEST(Answer, SendsTheWholeWithTagLengthAndName) {
    const auto response = send_bytes(get(), "0123456789", kHead);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.body, "0123456789");
    EXPECT_EQ(response.header("etag"), "\"" + sha256_of("0123456789") + "\"");
    EXPECT_NE(response.header("content-disposition")->find("a.ply"), std::string::npos);
}

TEST(Answer, SendsASingleRange) {
    const auto response = send_bytes(get({{"range", "bytes=2-4"}}), "0123456789", kHead);
    EXPECT_EQ(response.status, 206);
    EXPECT_EQ(response.body, "234");
    EXPECT_EQ(response.header("content-range"), "bytes 2-4/10");
}

TEST(Answer, SendsTheEndOfAFile) {
    EXPECT_EQ(send_bytes(get({{"range", "bytes=-3"}}), "0123456789", kHead).body, "789");
}

TEST(Answer, IgnoresManyRanges) {
    const auto response = send_bytes(get({{"range", "bytes=0-1,3-4,6-7"}}), "0123456789", kHead);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.body.size(), 10U);
}

TEST(Answer, RefusesARangeBehindTheEnd) {
    const auto response = send_bytes(get({{"range", "bytes=99-"}}), "0123456789", kHead);
    EXPECT_EQ(response.status, 416);
    EXPECT_EQ(response.header("content-range"), "bytes */10");
    EXPECT_EQ(response.content_type, "application/problem+json");
}

TEST(Answer, IfRangeWithAnotherTagGetsTheWhole) {
    const auto response =
        send_bytes(get({{"range", "bytes=2-4"}, {"if-range", "\"old\""}}), "0123456789", kHead);
    EXPECT_EQ(response.status, 200);
}

TEST(Answer, AClientThatHasItGets304) {
    const std::string tag = "\"" + sha256_of("x") + "\"";
    for (const std::string& header : {tag, "W/" + tag, std::string("*"), "\"a\", " + tag}) {
        const auto response = send_bytes(get({{"if-none-match", header}}), "x", kHead);
        EXPECT_EQ(response.status, 304) << header;
        EXPECT_TRUE(response.body.empty());
        EXPECT_EQ(response.header("etag"), tag);
    }
}

TEST(Answer, ProblemsNameThePathAndTheRequest) {
    const auto response = problem_response(
        {.problem = ProblemCode::QueueFull, .detail = "Full.", .retry_after = 7}, get());
    EXPECT_EQ(response.status, 503);
    EXPECT_EQ(response.header("Retry-After"), "7");
    const auto json = nlohmann::json::parse(response.body);
    EXPECT_EQ(json["code"], "queue-full");
    EXPECT_EQ(json["instance"], "/v1/x");
    EXPECT_EQ(json["requestId"], "id-1");
}

TEST(Answer, UnknownQueryFieldsAreRefused) {
    http::Request request = get();
    request.query = {{"formta", "drc"}};
    EXPECT_THROW(allow_query(request, {"format"}), ProblemException);
    request.query = {{"format", "drc"}};
    EXPECT_NO_THROW(allow_query(request, {"format"}));
}

TEST(Answer, QueryNumbersHaveARange) {
    http::Request request = get();
    EXPECT_EQ(query_number(request, "limit", 100, 20), 20U);
    request.query = {{"limit", "7"}};
    EXPECT_EQ(query_number(request, "limit", 100, 20), 7U);
    for (const char* wrong : {"0", "101", "-1", "x", ""}) {
        request.query = {{"limit", wrong}};
        EXPECT_THROW((void)query_number(request, "limit", 100, 20), ProblemException) << wrong;
    }
}

}  // namespace
}  // namespace lpf::server
