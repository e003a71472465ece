#pragma once

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http/connection.h"
#include "server/http/transport.h"

namespace lpf::http {

/// Sends feeds: one thread asks them all for what is new, and sends as each client reads.
class EventStreams {
public:
    enum class Admission { Granted, HouseFull, ClientFull };

    explicit EventStreams(const Limits& limits);
    ~EventStreams() { stop(); }
    EventStreams(const EventStreams&) = delete;
    EventStreams& operator=(const EventStreams&) = delete;

    /// Counts a stream of `owner` (a key, or an address without keys). If it is granted, `take`
    /// has to follow.
    Admission reserve(const std::string& owner);
    /// Takes the connection for good: it is closed at the end of the feed.
    void take(ConnectionPtr connection, Outgoing answer, const std::string& owner);

    /// Sends what there is to send, and ends all streams.
    void stop();

private:
    struct Stream {
        ConnectionPtr connection;
        std::shared_ptr<Feed> feed;
        std::string owner;
        bool chunked = false;
        std::string unsent = {};
        bool complete = false;                     // nothing will be added to `unsent`
        Clock::time_point moved = Clock::now();    // when the client last took something
        Clock::time_point written = Clock::now();  // when there last was something to send
    };

    void run();
    void wait_for_clients() const;
    /// @returns false when the stream is over
    bool advance(Stream& stream, bool last) const;
    static void ask(Stream& stream, bool last);
    static void append(Stream& stream, const std::string& text);
    void release(const std::string& owner);

    std::uint64_t most_;
    std::uint64_t most_per_owner_;  // 0: no limit
    std::chrono::seconds stall_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::vector<Stream> arriving_;
    std::map<std::string, std::uint64_t> owners_;
    std::uint64_t reserved_ = 0;
    bool stopping_ = false;
    std::vector<Stream> streams_;  // of the thread alone
    std::jthread thread_;
};

}  // namespace lpf::http
