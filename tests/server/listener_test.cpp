#include "server/http/listener.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "tests/server/raw_client.h"

namespace lpf::http {
namespace {

using server::RawClient;
using server::status_of;
using Clock = std::chrono::steady_clock;

/// A listener whose handler counts the bytes of a body, up to a limit.
class ListenerTest : public testing::Test {
protected:
    static constexpr std::size_t kLimit = 100'000;

    void SetUp() override {
        options_.threads = 4;
        options_.queue = 8;
        options_.limits.upload_bytes = kLimit;
        options_.head_deadline = std::chrono::seconds(1);
        start();
    }

    void start() {
        listener_ = std::make_unique<Listener>(
            options_, [this](Request& request) { return handle(request); },
            [](const Problem& problem) {
                Response response;
                response.status = problem.status();
                response.content_type = "application/problem+json";
                response.body = problem.detail;
                return response;
            });
        port_ = listener_->start();
    }

    Response handle(Request& request) {
        ++requests_;
        Response response;
        response.content_type = "text/plain";
        if (request.path == "/ignore") {
            response.status = 404;
            return response;
        }
        if (request.path == "/throw") throw std::runtime_error("secret");
        if (request.path == "/slow") std::this_thread::sleep_for(std::chrono::milliseconds(400));
        std::size_t bytes = 0;
        const bool complete = request.read_body([&](std::string_view piece) {
            bytes += piece.size();
            return bytes <= kLimit;
        });
        response.status = bytes > kLimit ? 413 : complete ? 200 : 400;
        response.body = request.method + " " + request.path + " " + std::to_string(bytes);
        return response;
    }

    [[nodiscard]] std::string ask(const std::string& text) const {
        return RawClient(port_).ask(text);
    }

    static std::string post(const std::string& path, const std::string& fields,
                            const std::string& body) {
        return "POST " + path + " HTTP/1.1\r\nHost: h\r\n" + fields + "\r\n" + body;
    }

    static std::string chunk(const std::string& data) {
        std::array<char, 32> size{};
        std::snprintf(size.data(), size.size(), "%zx\r\n", data.size());
        return size.data() + data + "\r\n";
    }

    ListenerOptions options_;
    std::atomic<int> requests_ = 0;
    std::unique_ptr<Listener> listener_;
    int port_ = 0;
};

TEST_F(ListenerTest, AnswersAndCloses) {
    const std::string answer = ask("GET /a%20b?x=1 HTTP/1.1\r\nHost: h\r\n\r\n");
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
    EXPECT_TRUE(answer.ends_with("GET /a b 0"));
    EXPECT_NE(answer.find("Date: "), std::string::npos);
}

TEST_F(ListenerTest, ReadsABodyByLength) {
    EXPECT_TRUE(ask(post("/", "Content-Length: 5\r\n", "12345")).ends_with("POST / 5"));
}

TEST_F(ListenerTest, ReadsAChunkedBody) {
    const std::string body = chunk("12345") + chunk("678") + "0\r\n\r\n";
    EXPECT_TRUE(ask(post("/", "Transfer-Encoding: chunked\r\n", body)).ends_with("POST / 8"));
}

TEST_F(ListenerTest, StopsAChunkedBodyAtTheLimit) {
    std::string body;
    for (int i = 0; i < 40; ++i) body += chunk(std::string(10'000, 'a'));
    const std::string answer = ask(post("/", "Transfer-Encoding: chunked\r\n", body));
    EXPECT_EQ(status_of(answer), 413);
}

TEST_F(ListenerTest, RefusesALargeLengthWithoutReadingTheBody) {
    const auto start = Clock::now();
    const std::string answer = ask(post("/", "Content-Length: 200000000\r\n", "a"));
    EXPECT_EQ(status_of(answer), 413);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(2));
    EXPECT_EQ(requests_, 0);
}

TEST_F(ListenerTest, ALargeWebFormIsABodyLikeAnyOther) {
    const std::string body(50'000, 'a');
    const std::string answer = ask(post(
        "/", "Content-Type: application/x-www-form-urlencoded\r\nContent-Length: 50000\r\n", body));
    EXPECT_TRUE(answer.ends_with("POST / 50000"));
}

TEST_F(ListenerTest, AnswersAPostWithoutLengthAtOnce) {
    const auto start = Clock::now();
    EXPECT_EQ(status_of(ask("POST / HTTP/1.1\r\nHost: h\r\n\r\n")), 411);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(3));
}

TEST_F(ListenerTest, AnUnreadBodyIsNeverTheNextRequest) {
    const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: h\r\n\r\n";
    const std::string answer =
        ask(post("/ignore", "Content-Length: " + std::to_string(hidden.size()) + "\r\n", hidden));
    EXPECT_EQ(status_of(answer), 404);
    EXPECT_EQ(answer.find("hidden"), std::string::npos);
    EXPECT_EQ(requests_, 1);
}

TEST_F(ListenerTest, PipelinedRequestsAreNotServed) {
    const std::string one = "GET /1 HTTP/1.1\r\nHost: h\r\n\r\n";
    const std::string answer = ask(one + one);
    EXPECT_EQ(answer.find("HTTP/1.1", 5), std::string::npos);
    EXPECT_EQ(requests_, 1);
}

TEST_F(ListenerTest, ManyRangesAreNotServedByTheLibrary) {
    std::string ranges = "Range: bytes=0-";
    for (int i = 0; i < 50; ++i) ranges += ",0-";
    const std::string answer = ask("GET /x HTTP/1.1\r\nHost: h\r\n" + ranges + "\r\n\r\n");
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_TRUE(answer.ends_with("GET /x 0"));
}

TEST_F(ListenerTest, ExceptionTextsStayInside) {
    const std::string answer = ask("GET /throw HTTP/1.1\r\nHost: h\r\n\r\n");
    EXPECT_EQ(status_of(answer), 500);
    EXPECT_EQ(answer.find("secret"), std::string::npos);
}

TEST_F(ListenerTest, AnEndlessHeadIsRefused) {
    const RawClient client(port_);
    client.send("GET / HTTP/1.1\r\n");
    for (int i = 0; i < 200 && client.send("A: " + std::string(1000, 'a')); ++i) {
    }
    EXPECT_EQ(status_of(client.read_all()), 431);
}

TEST_F(ListenerTest, ASlowHeadRunsIntoItsDeadline) {
    const RawClient client(port_);
    client.send("GET / HT");
    const auto start = Clock::now();
    EXPECT_EQ(status_of(client.read_all()), 408);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(5));
}

TEST_F(ListenerTest, SilentClientsHoldAThreadForTheDeadlineOnly) {
    std::vector<std::unique_ptr<RawClient>> silent;
    for (int i = 0; i < 4; ++i) silent.push_back(std::make_unique<RawClient>(port_));
    const auto start = Clock::now();
    EXPECT_EQ(status_of(ask("GET / HTTP/1.1\r\nHost: h\r\n\r\n")), 200);
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(4));
}

TEST_F(ListenerTest, ACutBodyIsIncomplete) {
    const RawClient client(port_);
    client.send(post("/", "Content-Length: 100\r\n", "abc"));
    client.end();
    EXPECT_EQ(status_of(client.read_all()), 400);
}

TEST_F(ListenerTest, MoreConnectionsThanTheQueueHoldsGet503) {
    std::vector<std::unique_ptr<RawClient>> silent;
    for (int i = 0; i < 4; ++i) silent.push_back(std::make_unique<RawClient>(port_));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // all threads are taken
    for (int i = 0; i < 20; ++i) silent.push_back(std::make_unique<RawClient>(port_));
    int refused = 0;
    for (int i = 0; i < 4; ++i)
        refused += status_of(ask("GET / HTTP/1.1\r\nHost: h\r\n\r\n")) == 503 ? 1 : 0;
    EXPECT_GT(refused, 0);
}

TEST_F(ListenerTest, ExpectContinueIsAnswered) {
    const RawClient client(port_);
    client.send(post("/", "Content-Length: 2\r\nExpect: 100-continue\r\n", ""));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    client.send("ab");
    const std::string answer = client.read_all();
    EXPECT_EQ(status_of(answer), 100);
    EXPECT_TRUE(answer.ends_with("POST / 2"));
}

TEST_F(ListenerTest, AStopLetsRequestsInFlightEnd) {
    std::string answer;
    std::jthread client([&] { answer = ask("GET /slow HTTP/1.1\r\nHost: h\r\n\r\n"); });
    while (requests_ == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    listener_->stop(std::chrono::seconds(5));
    client.join();
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_FALSE(RawClient(port_).connected());
}

TEST_F(ListenerTest, AStopDoesNotWaitForSilentClients) {
    const RawClient silent(port_);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto start = Clock::now();
    listener_->stop(std::chrono::seconds(5));
    EXPECT_LT(Clock::now() - start, std::chrono::milliseconds(800));
}

TEST_F(ListenerTest, APortThatIsTakenIsAnError) {
    options_.port = port_;
    EXPECT_THROW(Listener(options_, {}, {}).start(), Error);
}

}  // namespace
}  // namespace lpf::http
