#include "server/gate/origins.h"

#include <gtest/gtest.h>

#include "api/problem.h"
#include "core/base/error.h"

namespace lpf::gate {
namespace {

http::Request request(const std::string& method, const std::string& host,
                      const std::string& origin = "") {
    http::Request made;
    made.method = method;
    made.headers = {{"host", host}};
    if (!origin.empty()) made.headers.emplace_back("origin", origin);
    return made;
}

bool lets_in(const Origins& origins, const http::Request& request) {
    try {
        origins.check(request);
        return true;
    } catch (const ProblemException& refusal) {
        EXPECT_EQ(refusal.problem().problem, ProblemCode::Forbidden);
        return false;
    }
}

TEST(Origins, PagesOfOthersMayNotChangeAnything) {
    const Origins none({}, true);
    EXPECT_TRUE(lets_in(none, request("POST", "127.0.0.1:8080")));
    EXPECT_TRUE(lets_in(none, request("POST", "127.0.0.1:8080", "http://127.0.0.1:8080")));
    EXPECT_TRUE(lets_in(none, request("POST", "LOCALHOST", "http://localhost")));
    EXPECT_TRUE(lets_in(none, request("GET", "127.0.0.1:8080", "https://evil.example")));
    EXPECT_FALSE(lets_in(none, request("POST", "127.0.0.1:8080", "https://evil.example")));
    EXPECT_FALSE(lets_in(none, request("DELETE", "127.0.0.1:8080", "http://127.0.0.1:9090")));
    EXPECT_FALSE(lets_in(none, request("POST", "127.0.0.1:8080", "null")));
}

TEST(Origins, BehindAProxyThePageIsKnownByTheHost) {
    const Origins none({}, false);
    EXPECT_TRUE(lets_in(none, request("POST", "lpf.example", "https://lpf.example")));
    EXPECT_TRUE(lets_in(none, request("POST", "lpf.example:444", "https://lpf.example:444")));
    EXPECT_FALSE(lets_in(none, request("POST", "lpf.example", "https://evil.example")));
}

TEST(Origins, ALocalServerIsNotTakenInByADnsName) {
    const Origins none({}, true);
    EXPECT_FALSE(lets_in(none, request("GET", "rebound.evil.example:8080")));
    EXPECT_FALSE(lets_in(none, request("POST", "evil.example", "http://evil.example")));
    for (const char* host : {"localhost:8080", "127.0.0.1", "[::1]:8080", "lpf.localhost", "box"})
        EXPECT_TRUE(lets_in(none, request("GET", host))) << host;
}

TEST(Origins, NamedPagesMay) {
    const Origins named({"https://Pages.example:443", "http://localhost:3000"}, true);
    EXPECT_TRUE(lets_in(named, request("POST", "127.0.0.1", "https://pages.example")));
    EXPECT_TRUE(lets_in(named, request("POST", "127.0.0.1", "http://localhost:3000")));
    EXPECT_FALSE(lets_in(named, request("POST", "127.0.0.1", "http://localhost:3001")));
    http::Response answer;
    answer.set("Vary", "Accept");
    named.dress(request("GET", "127.0.0.1", "https://pages.example"), answer);
    EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), "https://pages.example");
    EXPECT_EQ(answer.header("Vary"), "Accept, Origin");
    EXPECT_FALSE(answer.header("Access-Control-Allow-Credentials"));
    http::Response other;
    named.dress(request("GET", "127.0.0.1", "https://evil.example"), other);
    EXPECT_FALSE(other.header("Access-Control-Allow-Origin"));
    EXPECT_EQ(other.header("Vary"), "Origin");
}

TEST(Origins, AStarIsForAllButWithoutCredentials) {
    const Origins any({"*"}, true);
    EXPECT_TRUE(lets_in(any, request("POST", "127.0.0.1", "null")));
    http::Response answer;
    any.dress(request("GET", "127.0.0.1", "https://pages.example"), answer);
    EXPECT_EQ(answer.header("Access-Control-Allow-Origin"), "*");
    EXPECT_FALSE(answer.header("Access-Control-Allow-Credentials"));
}

TEST(Origins, WhatIsNoOriginIsRefused) {
    for (const char* text :
         {"pages.example", "https://pages.example/", "null", "", "https://*.example",
          "ftp://pages.example", "https://a.example,https://b.example"})
        EXPECT_THROW(Origins({text}, true), Error) << text;
}

}  // namespace
}  // namespace lpf::gate
