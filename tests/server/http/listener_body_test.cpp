// Bodies of requests: framing, compression, size and pace.
#include <zlib.h>

#include "tests/server/http/listener_fixture.h"

namespace lpf::http {
namespace {

std::string gzip(const std::string& data) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string out(deflateBound(&stream, data.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream.avail_in = static_cast<uInt>(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

class BodyTest : public ListenerTest {
protected:
    [[nodiscard]] std::string ask_chunked(const std::string& body) const {
        return ask(post("/", "Transfer-Encoding: chunked\r\n", body));
    }
    [[nodiscard]] std::string ask_packed(const std::string& body) const {
        return ask(post(
            "/",
            "Content-Encoding: gzip\r\nContent-Length: " + std::to_string(body.size()) + "\r\n",
            body));
    }
};

TEST_F(BodyTest, ReadsABodyByLength) {
    EXPECT_TRUE(ask(post("/", "Content-Length: 5\r\n", "12345")).ends_with("POST / 5"));
}

TEST_F(BodyTest, ALargeWebFormIsABodyLikeAnyOther) {
    const std::string body(50'000, 'a');
    const std::string answer = ask(post(
        "/", "Content-Type: application/x-www-form-urlencoded\r\nContent-Length: 50000\r\n", body));
    EXPECT_TRUE(answer.ends_with("POST / 50000"));
}

TEST_F(BodyTest, ReadsAChunkedBody) {
    EXPECT_TRUE(ask_chunked(chunk("12345") + chunk("678") + "0\r\n\r\n").ends_with("POST / 8"));
}

TEST_F(BodyTest, ReadsOverExtensionsAndTrailers) {
    const std::string answer =
        ask_chunked("5;name=\"value\"\r\n12345\r\n0\r\nDigest: x\r\nOther: y\r\n\r\n");
    EXPECT_TRUE(answer.ends_with("POST / 5"));
}

TEST_F(BodyTest, ChunksThatTwoServersCouldReadDifferentlyAreRefused) {
    for (const std::string body :
         {"+5\r\n12345\r\n0\r\n\r\n", "-1\r\n12345", "0x5\r\n12345\r\n0\r\n\r\n",
          " 5\r\n12345\r\n0\r\n\r\n", "5 \r\n12345\r\n0\r\n\r\n", "5zz\r\n12345\r\n0\r\n\r\n",
          "5\n12345\n0\n\n", "5\r\n12345\n0\r\n\r\n", "5;a\nb\r\n12345\r\n0\r\n\r\n",
          "\r\n5\r\n12345\r\n0\r\n\r\n", "4\r\n12345\r\n0\r\n\r\n", "6\r\n12345\r\n0\r\n\r\n",
          "10000000000000005\r\n12345\r\n0\r\n\r\n", "5;a\r\rb\r\n12345\r\n0\r\n\r\n",
          "0\r\nno trailer\r\n\r\n", "0\r\nA: b\n\r\n"}) {
        const std::string answer = ask_chunked(body);
        EXPECT_EQ(status_of(answer), 400) << body;
        EXPECT_EQ(answer.find("HTTP/1.1", 5), std::string::npos) << body;
    }
}

TEST_F(BodyTest, StopsAChunkedBodyAtTheLimit) {
    std::string body;
    for (int i = 0; i < 40; ++i) body += chunk(std::string(10'000, 'a'));
    EXPECT_EQ(status_of(ask_chunked(body)), 413);
}

TEST_F(BodyTest, FramingWithoutDataIsRefused) {
    EXPECT_EQ(status_of(ask_chunked("1;" + std::string(5000, 'a'))), 400);
    std::string body;
    for (int i = 0; i < 200; ++i) body += "1;" + std::string(1000, 'a') + "\r\nx\r\n";
    EXPECT_EQ(status_of(ask_chunked(body + "0\r\n\r\n")), 400);
}

TEST_F(BodyTest, WhatFollowsAChunkedBodyIsTheNextRequest) {
    const RawClient client(port_);
    client.send(post("/", "Transfer-Encoding: chunked\r\n", chunk("12") + "0\r\n\r\n") + get("/2"));
    EXPECT_NE(client.read_until("POST / 2"), "");
    EXPECT_NE(client.read_until("GET /2 0"), "");
}

TEST_F(BodyTest, InflatesGzip) {
    EXPECT_TRUE(ask_packed(gzip(std::string(90'000, 'a'))).ends_with("POST / 90000"));
    EXPECT_TRUE(ask_packed(gzip("two") + gzip("members")).ends_with("POST / 10"));
}

TEST_F(BodyTest, AGzipBombStopsAtTheLimit) {
    const std::string bomb = gzip(std::string(50'000'000, 'a'));
    ASSERT_LT(bomb.size(), kLimit);
    const std::string answer = ask_packed(bomb);
    EXPECT_EQ(status_of(answer), 413);
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
}

TEST_F(BodyTest, BrokenGzipIsRefused) {
    const std::string packed = gzip("some data that is long enough");
    EXPECT_EQ(status_of(ask_packed("no gzip at all")), 400);
    EXPECT_EQ(status_of(ask_packed(packed.substr(0, packed.size() - 4))), 400);
    EXPECT_EQ(status_of(ask_packed(packed + "rubbish")), 400);
}

TEST_F(BodyTest, OtherCompressionsAreRefusedByTheHead) {
    for (const char* coding : {"br", "deflate", "gzip, gzip", "zstd"}) {
        const std::string answer = ask(post(
            "/", "Content-Length: 5\r\nContent-Encoding: " + std::string(coding) + "\r\n", ""));
        EXPECT_EQ(status_of(answer), 415) << coding;
    }
    EXPECT_EQ(requests_, 0);
}

TEST_F(BodyTest, ACutBodyIsIncomplete) {
    EXPECT_EQ(status_of(ask(post("/", "Content-Length: 100\r\n", "abc"))), 400);
}

TEST_F(BodyTest, ABodyThatStopsComingRunsIntoItsTime) {
    const RawClient client(port_);
    const auto begin = Watch::now();
    client.send(post("/", "Content-Length: 100\r\n", "abc"));
    EXPECT_EQ(status_of(client.read_all()), 408);
    EXPECT_LT(Watch::now() - begin, seconds(5));
}

TEST_F(BodyTest, ABodyHasATimeInAll) {
    options_.limits.body_seconds = 1;
    restart();
    const RawClient client(port_);
    client.send(post("/", "Content-Length: 100\r\n", ""));
    for (int i = 0; i < 20 && client.send("a"); ++i) std::this_thread::sleep_for(milliseconds(100));
    EXPECT_EQ(status_of(client.read_all()), 408);
}

TEST_F(BodyTest, ExpectContinueIsAnsweredWhenTheBodyIsWanted) {
    const RawClient client(port_);
    client.send(post("/", "Content-Length: 2\r\nExpect: 100-continue\r\n", ""));
    EXPECT_EQ(client.read_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
    client.send("ab");
    EXPECT_NE(client.read_until("POST / 2"), "");
}

TEST_F(BodyTest, ABodyThatNobodyWantsIsNotAskedFor) {
    const std::string expect = "Expect: 100-continue\r\n";
    EXPECT_EQ(status_of(ask(post("/", "Content-Length: 200000\r\n" + expect, ""))), 413);
    const std::string answer = ask(post("/ignore", "Content-Length: 2\r\n" + expect, ""));
    EXPECT_EQ(status_of(answer), 404);
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
}

TEST_F(BodyTest, FormsAreSplit) {
    const std::string body =
        "--b\r\nContent-Disposition: form-data; filename*=UTF-8''x; name=file\r\n\r\n123\r\n"
        "--b\r\nContent-Disposition: form-data; name=\"n\"\r\n\r\n4\r\n--b--";
    const std::string type = "Content-Type: multipart/form-data; boundary=b\r\n";
    const auto answer_to = [&](const std::string& form) {
        return ask(post("/form", type + "Transfer-Encoding: chunked\r\n",
                        chunk(form.substr(0, 70)) + chunk(form.substr(70)) + "0\r\n\r\n"));
    };
    EXPECT_TRUE(answer_to(body).ends_with("[file]123[n]4"));
    EXPECT_EQ(status_of(answer_to(body.substr(0, body.size() - 4))), 400);
    EXPECT_EQ(status_of(ask(post(
                  "/form", "Content-Type: multipart/form-data\r\nContent-Length: 1\r\n", "x"))),
              400);
}

}  // namespace
}  // namespace lpf::http
