#include "server/http/head.h"

#include <gtest/gtest.h>

#include "api/problem.h"

namespace lpf::http {
namespace {

int status_of(const std::string& text, const Limits& limits = {}) {
    try {
        (void)parse_head(text, limits);
        return 200;
    } catch (const ProblemException& error) {
        return error.problem().status();
    }
}

TEST(Head, ReadsMethodPathQueryAndFields) {
    const Head head = parse_head(
        "POST /v1/a%20b?x=1&y=a+b%26&z HTTP/1.1\r\nHost: h\r\nContent-Length:  12 \r\n\r\n", {});
    EXPECT_EQ(head.method, "POST");
    EXPECT_EQ(head.path, "/v1/a b");
    EXPECT_EQ(head.query, (Fields{{"x", "1"}, {"y", "a b&"}, {"z", ""}}));
    EXPECT_EQ(head.content_length, 12U);
    EXPECT_TRUE(head.has_body());
}

TEST(Head, AcceptsTheAbsoluteFormOfATarget) {
    EXPECT_EQ(parse_head("GET http://h:1/v1/info?a=b HTTP/1.1\r\nHost: h\r\n\r\n", {}).path,
              "/v1/info");
}

TEST(Head, HeadOfOldProtocolNeedsNoHost) { EXPECT_EQ(status_of("GET / HTTP/1.0\r\n\r\n"), 200); }

struct BadHead {
    const char* name;
    std::string text;
    int status;
};

class RefusedHead : public testing::TestWithParam<BadHead> {};

TEST_P(RefusedHead, IsAnsweredWithItsStatus) {
    EXPECT_EQ(status_of(GetParam().text), GetParam().status);
}

std::string post(const std::string& fields) {
    return "POST / HTTP/1.1\r\nHost: h\r\n" + fields + "\r\n";
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedHead,
    testing::Values(
        BadHead{"LengthIsAWord", post("Content-Length: abc\r\n"), 400},
        BadHead{"LengthIsNegative", post("Content-Length: -1\r\n"), 400},
        BadHead{"LengthHasASign", post("Content-Length: +5\r\n"), 400},
        BadHead{"LengthOverflows", post("Content-Length: 99999999999999999999\r\n"), 413},
        BadHead{"LengthOverTheLimit", post("Content-Length: 536870913\r\n"), 413},
        BadHead{"LengthTwice", post("Content-Length: 1\r\nContent-Length: 2\r\n"), 400},
        BadHead{"LengthAndChunked", post("Content-Length: 1\r\nTransfer-Encoding: chunked\r\n"),
                400},
        BadHead{"UnknownTransferCoding", post("Transfer-Encoding: gzip\r\n"), 400},
        BadHead{"ChunkedTwice", post("Transfer-Encoding: chunked, chunked\r\n"), 400},
        BadHead{"TransferEncodingTwice",
                post("Transfer-Encoding: chunked\r\nTransfer-Encoding: x\r\n"), 400},
        BadHead{"ChunkedWithParameter", post("Transfer-Encoding: chunked;a=b\r\n"), 400},
        BadHead{"ChunkedInOldProtocol", "POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n",
                400},
        BadHead{"LengthIsAList", post("Content-Length: 1, 1\r\n"), 400},
        BadHead{"LengthIsEmpty", post("Content-Length:\r\n"), 400},
        BadHead{"LengthIsHexadecimal", post("Content-Length: 0x1\r\n"), 400},
        BadHead{"BareCarriageReturn", post("A: b\rC: d\r\nContent-Length: 1\r\n"), 400},
        BadHead{"Nul", post(std::string("A: b\0c\r\nContent-Length: 1\r\n", 27)), 400},
        BadHead{"FieldWithoutName", post(": b\r\nContent-Length: 1\r\n"), 400},
        BadHead{"UnknownContentCoding", post("Content-Length: 1\r\nContent-Encoding: br\r\n"), 415},
        BadHead{"NoLength", post(""), 411}, BadHead{"FieldWithoutColon", post("nonsense\r\n"), 400},
        BadHead{"BlankBeforeColon", post("Content-Length : 1\r\n"), 400},
        BadHead{"FoldedField", post("A: b\r\n c\r\nContent-Length: 1\r\n"), 400},
        BadHead{"ControlCharacter", post("A: b\x01\r\nContent-Length: 1\r\n"), 400},
        BadHead{"NoHost", "GET / HTTP/1.1\r\n\r\n", 400},
        BadHead{"TwoHosts", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", 400},
        BadHead{"UnknownMethod", "BREW / HTTP/1.1\r\nHost: h\r\n\r\n", 405},
        BadHead{"UnknownVersion", "GET / HTTP/3.0\r\nHost: h\r\n\r\n", 400},
        BadHead{"BlankInTarget", "GET /a b HTTP/1.1\r\nHost: h\r\n\r\n", 400},
        BadHead{"RelativeTarget", "GET a HTTP/1.1\r\nHost: h\r\n\r\n", 400},
        BadHead{"BrokenEscape", "GET /%4 HTTP/1.1\r\nHost: h\r\n\r\n", 400},
        BadHead{"EncodedNul", "GET /%00 HTTP/1.1\r\nHost: h\r\n\r\n", 400},
        BadHead{"LongTarget", "GET /" + std::string(9000, 'a') + " HTTP/1.1\r\nHost: h\r\n\r\n",
                414},
        BadHead{"HugeField", post("A: " + std::string(40000, 'a') + "\r\n"), 431}),
    [](const auto& tested) { return tested.param.name; });

TEST(Head, TooManyFieldsAreRefused) {
    std::string fields = "Content-Length: 0\r\n";
    for (int i = 0; i < 100; ++i) fields += "A" + std::to_string(i) + ": b\r\n";
    EXPECT_EQ(status_of(post(fields)), 431);
}

TEST(Head, TransportSeesNoPathNoRangeAndNoForgedAddress) {
    const Head head = parse_head(
        "GET /secret HTTP/1.1\r\nHost: h\r\nRange: bytes=0-1\r\nREMOTE_ADDR: 1.2.3.4\r\n"
        "Accept-Encoding: gzip\r\n\r\n",
        {});
    EXPECT_EQ(transport_head(head), "GET / HTTP/1.1\r\naccept-encoding: gzip\r\n\r\n");
}

TEST(Head, EndIsFoundAfterTheEmptyLine) {
    EXPECT_EQ(end_of_head("GET / HTTP/1.1\r\n"), std::string::npos);
    EXPECT_EQ(end_of_head("A\r\n\r\nrest"), 5U);
    EXPECT_EQ(end_of_head("A\r\n\r\nrest", 4), 5U);
    EXPECT_THROW((void)end_of_head("A\n\n"), ProblemException);
    EXPECT_THROW((void)end_of_head("\n"), ProblemException);
    EXPECT_THROW((void)end_of_head("A\r\nB: c\n\r\n"), ProblemException);
}

TEST(Head, TellsWhatTheClientSaysAboutTheConnection) {
    const auto kept = [](const std::string& version, const std::string& field) {
        return parse_head("GET / " + version + "\r\nHost: h\r\n" + field + "\r\n", {}).keep_alive;
    };
    EXPECT_TRUE(kept("HTTP/1.1", ""));
    EXPECT_TRUE(kept("HTTP/1.1", "Connection: keep-alive, x-close\r\n"));
    EXPECT_FALSE(kept("HTTP/1.1", "Connection: close\r\n"));
    EXPECT_FALSE(kept("HTTP/1.1", "Connection: TE, Close\r\n"));
    EXPECT_FALSE(kept("HTTP/1.0", ""));
}

}  // namespace
}  // namespace lpf::http
