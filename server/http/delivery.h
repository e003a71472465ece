#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <vector>

#include "server/http/connection.h"
#include "server/http/poller.h"
#include "server/http/transport.h"

namespace lpf::http {

/// Sends answers. What a client does not take at once is sent by one thread for all, as each client
/// reads: a slow one costs a descriptor, not a thread.
class Delivery {
public:
    /// Gets the connection back when the whole answer is sent.
    using Done = std::function<void(ConnectionPtr, bool keep_alive)>;

    Delivery(const Limits& limits, Done done);
    ~Delivery() { stop(); }
    Delivery(const Delivery&) = delete;
    Delivery& operator=(const Delivery&) = delete;

    /// Takes an answer without a feed.
    void take(ConnectionPtr connection, Outgoing answer);

    /// False when the answers that wait for their readers fill the memory set aside for them.
    [[nodiscard]] bool has_room(const Outgoing& answer) const;

    /// Ends the thread, and drops what is not sent.
    void stop();

private:
    struct Parcel {
        ConnectionPtr connection;
        Outgoing answer;
        std::size_t sent = 0;  // of text and body together
        Clock::time_point moved = Clock::now();
    };
    enum class Progress { Sent, Waiting, Broken };

    void run();
    void accept_parcels();
    void advance(int socket);
    void drop_stalled();
    void forget(int socket);
    static Progress send(Parcel& parcel);
    static Progress send_memory(Parcel& parcel);
    static Progress send_file(Parcel& parcel);

    std::chrono::seconds stall_;
    Done done_;
    Poller poller_;
    std::mutex mutex_;
    std::vector<Parcel> arriving_;
    std::unordered_map<int, Parcel> parcels_;  // by socket; of the thread alone
    std::atomic<std::size_t> held_ = 0;        // bytes
    std::atomic<bool> stopping_ = false;
    std::jthread thread_;
};

}  // namespace lpf::http
