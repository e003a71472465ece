#include "server/requests/idempotency.h"

#include <gtest/gtest.h>

#include "api/problem.h"

namespace lpf::server {
namespace {

http::Request request(const std::string& path, http::Fields query) {
    http::Request made;
    made.method = "POST";
    made.path = path;
    made.query = std::move(query);
    return made;
}

TEST(Idempotency, AKeyMayStandInQuotationMarks) {
    EXPECT_EQ(idempotency_key("8e03978e-40d5"), "8e03978e-40d5");
    EXPECT_EQ(idempotency_key("\"8e03978e-40d5\""), "8e03978e-40d5");
}

TEST(Idempotency, KeysThatAreEmptyLongOrUnprintableAreRefused) {
    for (const std::string& key : {std::string(), std::string("\"\""), std::string(256, 'a'),
                                   std::string("a\tb"), std::string("\xc3\xa4")})
        EXPECT_THROW((void)idempotency_key(key), ProblemException) << key;
}

TEST(Idempotency, TheOrderOfTheQueryDoesNotCount) {
    EXPECT_EQ(fingerprint(request("/a", {{"x", "1"}, {"y", "2"}}), "d"),
              fingerprint(request("/a", {{"y", "2"}, {"x", "1"}}), "d"));
}

TEST(Idempotency, PathQueryAndBodyCount) {
    const std::string one = fingerprint(request("/a", {{"x", "1"}}), "d");
    EXPECT_NE(one, fingerprint(request("/b", {{"x", "1"}}), "d"));
    EXPECT_NE(one, fingerprint(request("/a", {{"x", "2"}}), "d"));
    EXPECT_NE(one, fingerprint(request("/a", {{"x", "1"}}), "e"));
    EXPECT_NE(one, fingerprint(request("/a", {}), "d"));
    EXPECT_NE(fingerprint(request("/a", {{"ab", "c"}}), "d"),
              fingerprint(request("/a", {{"a", "bc"}}), "d"));
}

TEST(Idempotency, ASecondRequestIsSentAwayWhileTheFirstIsInFlight) {
    RequestsInFlight in_flight;
    {
        const auto seat = in_flight.enter({"owner", "key"});
        EXPECT_THROW((void)in_flight.enter({"owner", "key"}), ProblemException);
        EXPECT_NO_THROW((void)in_flight.enter({"other", "key"}));
    }
    EXPECT_NO_THROW((void)in_flight.enter({"owner", "key"}));
}

}  // namespace
}  // namespace lpf::server
