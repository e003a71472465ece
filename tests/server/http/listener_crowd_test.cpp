// Many clients, and slow ones: none of them may keep the others from being served.
#include <sys/resource.h>

#include <fstream>

#include "tests/server/http/listener_fixture.h"

namespace lpf::http {
namespace {

using Clients = std::vector<std::unique_ptr<RawClient>>;

class CrowdTest : public ListenerTest {
protected:
    /// @param text sent by each of them
    [[nodiscard]] Clients crowd(int count, const std::string& text) const {
        Clients clients;
        for (int i = 0; i < count; ++i) {
            clients.push_back(std::make_unique<RawClient>(port_));
            clients.back()->send(text);
        }
        return clients;
    }

    void wait_for_requests(int count) const {
        const auto end = Watch::now() + seconds(5);
        while (requests_ < count && Watch::now() < end)
            std::this_thread::sleep_for(milliseconds(1));
        ASSERT_GE(requests_, count);
    }
};

TEST_F(CrowdTest, SilentClientsHoldNoThread) {
    const Clients silent = crowd(100, "");
    EXPECT_LT(time_of_a_get(), milliseconds(500));
}

TEST_F(CrowdTest, SlowHeadsHoldNoThread) {
    const Clients slow = crowd(100, "GET / HTTP/1.1\r\nHost");
    EXPECT_LT(time_of_a_get(), milliseconds(500));
}

TEST_F(CrowdTest, SlowBodiesHoldNoThreadThatOthersNeed) {
    const Clients slow = crowd(50, post("/", "Content-Length: 100\r\n", "a"));
    wait_for_requests(50);
    EXPECT_LT(time_of_a_get(), milliseconds(500));
}

TEST_F(CrowdTest, MoreUploadsThanThereAreThreadsForGet503) {
    options_.limits.uploads_at_once = 2;
    restart();
    const Clients slow = crowd(2, post("/", "Content-Length: 100\r\n", "a"));
    wait_for_requests(2);
    EXPECT_EQ(status_of(ask(post("/", "Content-Length: 1\r\n", "a"))), 503);
    EXPECT_LT(time_of_a_get(), milliseconds(500));
}

TEST_F(CrowdTest, AFullLaneAnswers503AndTheHealthCheckStillWorks) {
    const Clients busy = crowd(12, get("/slow"));
    wait_for_requests(4);
    EXPECT_EQ(status_of(ask(get("/"))), 503);
    const auto begin = Watch::now();
    EXPECT_EQ(status_of(ask(get("/healthz"))), 200);
    EXPECT_LT(Watch::now() - begin, milliseconds(300));
}

TEST_F(CrowdTest, LongRequestsHaveTheirOwnShare) {
    options_.limits.long_requests_at_once = 2;
    restart();
    const Clients busy = crowd(2, get("/convert"));
    wait_for_requests(2);
    EXPECT_EQ(status_of(ask(get("/convert"))), 503);
    EXPECT_LT(time_of_a_get(), milliseconds(300));
    const auto begin = Watch::now();  // a wait that cannot be granted is passed over
    EXPECT_EQ(status_of(ask(get("/", "Prefer: wait=10\r\n"))), 200);
    EXPECT_LT(Watch::now() - begin, milliseconds(300));
}

TEST_F(CrowdTest, ClientsThatDoNotReadHoldNoThread) {
    const server::TemporaryFolder folder;
    file_ = folder.path() / "file";
    std::ofstream(file_) << std::string(5'000'000, 'f');
    Clients clients;
    for (int i = 0; i < 50; ++i) {
        clients.push_back(std::make_unique<RawClient>(port_));
        clients.back()->read_little();
        clients.back()->send(get("/file"));
        if (i % 5 == 0) wait_for_requests(i + 1);  // else the queue of the lane is too short
    }
    wait_for_requests(50);
    EXPECT_LT(time_of_a_get(), milliseconds(500));
    const std::string answer = ask(get("/file"));
    EXPECT_EQ(answer.size() - answer.find("\r\n\r\n") - 4, 5'000'000U);
}

TEST_F(CrowdTest, AnswersInMemoryAreBounded) {
    Clients clients;
    int refused = 0;
    for (int i = 0; i < 6; ++i) {
        clients.push_back(std::make_unique<RawClient>(port_));
        clients.back()->send(get("/big"));
        refused += clients.back()->read_until("\r\n").find("503") != std::string::npos ? 1 : 0;
    }
    EXPECT_GT(refused, 0);
    EXPECT_LT(refused, 6);
    const std::string answer = clients.front()->read_until("\r\n\r\n");
    EXPECT_NE(answer.find("Content-Length: 30000000"), std::string::npos);
}

TEST_F(CrowdTest, AClientThatTakesNothingIsDropped) {
    options_.limits.write_stall_seconds = 1;
    restart();
    const RawClient client(port_);
    client.read_little();
    client.send(get("/big"));
    std::this_thread::sleep_for(seconds(3));
    EXPECT_LT(client.read_all().size(), 29'000'000U);
}

TEST_F(CrowdTest, ConnectionsAreCountedInAllAndPerClient) {
    options_.limits.connections_per_client = 3;
    restart();
    const Clients silent = crowd(3, "");
    EXPECT_EQ(status_of(RawClient(port_).read_all()), 429);
    options_.limits.connections_per_client = 0;
    options_.limits.connections = 3;
    restart();
    const Clients others = crowd(3, "");
    EXPECT_EQ(status_of(RawClient(port_).read_all()), 503);
}

TEST_F(CrowdTest, AnEventStreamComesInChunksAndEnds) {
    const std::string answer = RawClient(port_).ask(get("/ignore"));
    const RawClient client(port_);
    client.send(get("/events"));
    const std::string events = client.read_all();
    EXPECT_NE(events.find("Transfer-Encoding: chunked\r\n"), std::string::npos);
    EXPECT_TRUE(
        events.ends_with("9\r\ndata: 1\n\n\r\n9\r\ndata: 2\n\n\r\n9\r\ndata: 3\n\n\r\n0\r\n\r\n"))
        << events;
}

TEST_F(CrowdTest, OldClientsGetTheEventsWithoutChunks) {
    const RawClient client(port_);
    client.send("GET /events HTTP/1.0\r\n\r\n");
    const std::string events = client.read_all();
    EXPECT_EQ(events.find("chunked"), std::string::npos);
    EXPECT_TRUE(events.ends_with("\r\n\r\ndata: 1\n\ndata: 2\n\ndata: 3\n\n")) << events;
}

TEST_F(CrowdTest, EventStreamsAreCountedAndTheirSeatsComeBack) {
    options_.limits.event_streams_per_client = 2;
    restart();
    Clients streams = crowd(2, get("/endless"));
    wait_for_requests(2);
    EXPECT_EQ(status_of(ask(get("/endless"))), 429);
    EXPECT_LT(time_of_a_get(), milliseconds(500));
    streams.clear();
    int status = 429;
    for (int i = 0; i < 50 && status == 429; ++i) {
        std::this_thread::sleep_for(milliseconds(50));
        const RawClient client(port_);
        client.send(get("/endless"));
        status = status_of(client.read_until("\r\n"));
    }
    EXPECT_EQ(status, 200);
}

TEST_F(CrowdTest, AStreamThatIsNotReadIsCut) {
    const RawClient client(port_);
    client.read_little();
    client.send(get("/endless"));
    std::this_thread::sleep_for(seconds(3));  // half a megabyte comes each second
    const auto begin = Watch::now();
    EXPECT_FALSE(client.read_all().ends_with("0\r\n\r\n"));
    EXPECT_LT(Watch::now() - begin, seconds(5));
}

TEST_F(CrowdTest, RunningOutOfDescriptorsPassesOver) {
    rlimit before{};
    ::getrlimit(RLIMIT_NOFILE, &before);
    rlimit few = before;
    Clients clients = crowd(1, "");
    few.rlim_cur = 60;
    ::setrlimit(RLIMIT_NOFILE, &few);
    for (int i = 0; i < 40; ++i) clients.push_back(std::make_unique<RawClient>(port_));
    std::this_thread::sleep_for(milliseconds(300));
    rusage usage_before{};
    rusage usage_after{};
    ::getrusage(RUSAGE_SELF, &usage_before);
    std::this_thread::sleep_for(milliseconds(500));
    ::getrusage(RUSAGE_SELF, &usage_after);
    clients.clear();
    ::setrlimit(RLIMIT_NOFILE, &before);
    const auto busy = usage_after.ru_utime.tv_sec * 1'000'000 + usage_after.ru_utime.tv_usec -
                      usage_before.ru_utime.tv_sec * 1'000'000 - usage_before.ru_utime.tv_usec;
    EXPECT_LT(busy, 200'000) << "microseconds of computing within half a second of waiting";
    EXPECT_EQ(status_of(ask(get("/"))), 200);
}

}  // namespace
}  // namespace lpf::http
