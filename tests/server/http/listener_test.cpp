#include "tests/server/http/listener_fixture.h"

namespace lpf::http {
namespace {

TEST_F(ListenerTest, AnswersAndClosesWhenAskedTo) {
    const RawClient client(port_);
    client.send(get("/a%20b?x=1", "Connection: close\r\n"));
    const std::string answer = client.read_all();
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
    EXPECT_TRUE(answer.ends_with("GET /a b 0"));
    EXPECT_NE(answer.find("Date: "), std::string::npos);
}

TEST_F(ListenerTest, RefusesALargeLengthWithoutReadingTheBody) {
    const auto start = Watch::now();
    const std::string answer = ask(post("/", "Content-Length: 200000000\r\n", "a"));
    EXPECT_EQ(status_of(answer), 413);
    EXPECT_LT(Watch::now() - start, seconds(2));
    EXPECT_EQ(requests_, 0);
}

TEST_F(ListenerTest, AnswersAPostWithoutLengthAtOnce) {
    const auto start = Watch::now();
    EXPECT_EQ(status_of(ask("POST / HTTP/1.1\r\nHost: h\r\n\r\n")), 411);
    EXPECT_LT(Watch::now() - start, seconds(3));
}

TEST_F(ListenerTest, AnUnreadBodyIsNeverTheNextRequest) {
    const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: h\r\n\r\n";
    const std::string answer =
        ask(post("/ignore", "Content-Length: " + std::to_string(hidden.size()) + "\r\n", hidden));
    EXPECT_EQ(status_of(answer), 404);
    EXPECT_EQ(answer.find("hidden"), std::string::npos);
    EXPECT_EQ(requests_, 1);
}

TEST_F(ListenerTest, PipelinedRequestsAreServedInTurn) {
    const std::string answer = ask(get("/slow") + get("/2", "Connection: close\r\n") + get("/3"));
    const auto first = answer.find("GET /slow 0");
    EXPECT_NE(first, std::string::npos);
    EXPECT_GT(answer.find("GET /2 0"), first);
    EXPECT_EQ(requests_, 2);
}

TEST_F(ListenerTest, AConnectionServesManyRequestsButNotAllOfThem) {
    const RawClient client(port_);
    for (int i = 0; i < 3; ++i) {
        client.send(i == 1 ? post("/", "Content-Length: 2\r\n", "ab") : get("/"));
        const std::string answer = client.read_until(i == 1 ? "POST / 2" : "GET / 0");
        EXPECT_EQ(status_of(answer), 200) << i;
        EXPECT_EQ(answer.find("Connection: close") != std::string::npos, i == 2) << i;
    }
    EXPECT_EQ(client.read_all(), "");
}

TEST_F(ListenerTest, AnIdleConnectionIsEndedWithoutAWord) {
    const RawClient client(port_);
    client.send(get("/"));
    EXPECT_NE(client.read_until("GET / 0"), "");
    const auto begin = Watch::now();
    EXPECT_EQ(client.read_all(), "");
    EXPECT_GT(Watch::now() - begin, milliseconds(500));
    EXPECT_LT(Watch::now() - begin, seconds(5));
}

TEST_F(ListenerTest, OldClientsGetOneAnswer) {
    const RawClient client(port_);
    client.send("GET / HTTP/1.0\r\n\r\n");
    EXPECT_NE(client.read_all().find("Connection: close"), std::string::npos);
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
    const auto start = Watch::now();
    EXPECT_EQ(status_of(client.read_all()), 408);
    EXPECT_LT(Watch::now() - start, seconds(5));
}

TEST_F(ListenerTest, ACutBodyIsIncomplete) {
    const RawClient client(port_);
    client.send(post("/", "Content-Length: 100\r\n", "abc"));
    client.end();
    EXPECT_EQ(status_of(client.read_all()), 400);
}

TEST_F(ListenerTest, AStopLetsRequestsInFlightEnd) {
    std::string answer;
    std::jthread client([&] { answer = ask("GET /slow HTTP/1.1\r\nHost: h\r\n\r\n"); });
    while (requests_ == 0) std::this_thread::sleep_for(milliseconds(1));
    listener_->stop(seconds(5));
    client.join();
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_FALSE(RawClient(port_).connected());
}

TEST_F(ListenerTest, AStopDoesNotWaitForSilentClients) {
    const RawClient silent(port_);
    std::this_thread::sleep_for(milliseconds(50));
    const auto start = Watch::now();
    listener_->stop(seconds(5));
    EXPECT_LT(Watch::now() - start, milliseconds(800));
}

TEST_F(ListenerTest, AStopEndsEventStreamsAndWaitingRequests) {
    const RawClient stream(port_);
    const RawClient waiting(port_);
    stream.send(get("/endless"));
    waiting.send(get("/wait", "Prefer: wait=10\r\n"));
    EXPECT_NE(stream.read_until("data: 1"), "");
    while (requests_ < 2) std::this_thread::sleep_for(milliseconds(1));
    const auto begin = Watch::now();
    listener_->stop(seconds(8));
    EXPECT_LT(Watch::now() - begin, seconds(4));
    EXPECT_EQ(status_of(waiting.read_all()), 200);
}

TEST_F(ListenerTest, AStopCutsWhatOutlastsItsPatience) {
    const RawClient upload(port_);
    upload.send(post("/", "Content-Length: 100\r\n", "abc"));
    while (requests_ < 1) std::this_thread::sleep_for(milliseconds(1));
    const auto begin = Watch::now();
    listener_->stop(milliseconds(100));
    EXPECT_LT(Watch::now() - begin, milliseconds(900));
}

TEST_F(ListenerTest, APortThatIsTakenIsAnError) {
    options_.port = port_;
    EXPECT_THROW(Listener(options_, {}, {}).start(), Error);
}

}  // namespace
}  // namespace lpf::http
