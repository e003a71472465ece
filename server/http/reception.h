#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <vector>

#include "api/problem.h"
#include "server/http/connection.h"
#include "server/http/poller.h"

namespace lpf::http {

/// One thread that never waits for a single client: it lets connections in, reads heads as they
/// come, each within its deadline, and hands on what is complete. Connections that are kept come
/// back to it for their next request, others to be seen off.
class Reception {
public:
    /// What becomes of a client; both are called from the reception's thread and must not block.
    struct Calls {
        std::function<void(Arrival)> dispatch;
        std::function<void(ConnectionPtr, const Problem&)> refuse;
    };

    Reception(const Limits& limits, Guests& guests, Calls calls);
    ~Reception() { stop(); }
    Reception(const Reception&) = delete;
    Reception& operator=(const Reception&) = delete;

    /// @param listening a socket that does not block
    void start(int listening);

    /// The connection's request was answered, and another may follow. From any thread.
    void welcome_back(ConnectionPtr connection);
    /// Says goodbye: ends the sending side and swallows, for a short while, what the client still
    /// sends; closing at once would reset the connection and could take the answer with it.
    void see_off(ConnectionPtr connection);

    /// Lets nobody in any more, and ends connections that wait for a request.
    void leave();
    /// Ends the thread and the connections it has.
    void stop();

private:
    struct Guest {
        ConnectionPtr connection;
        bool departing = false;
        Clock::time_point deadline = {};
        std::size_t seen = 0;       // bytes of the input in which no head ends
        std::size_t swallowed = 0;  // while departing
    };

    void run();
    void let_in();
    void admit(Descriptor socket, const std::string& address);
    void take_returned();
    void take_up(Guest guest);
    void serve(int socket);
    void read_head(int socket, Guest& guest);
    void find_head(int socket, Guest& guest);
    void swallow(int socket, Guest& guest);
    void expire();
    void time_out(int socket, const Guest& guest);
    ConnectionPtr release(int socket);
    void refuse(int socket, const Problem& problem);
    void pause_if_out_of_descriptors(int error);

    const Limits& limits_;
    Guests& guests_;
    Calls calls_;
    Poller poller_;
    int listening_ = -1;
    bool accepting_ = false;
    Clock::time_point resume_ = {};  // when to accept again
    std::unordered_map<int, Guest> present_;
    std::mutex mutex_;
    std::vector<Guest> returned_;
    std::atomic<bool> leaving_ = false;
    std::atomic<bool> stopping_ = false;
    std::jthread thread_;
};

}  // namespace lpf::http
