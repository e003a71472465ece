#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "server/http/descriptor.h"
#include "server/http/guests.h"
#include "server/http/head.h"

namespace lpf::http {

using Clock = std::chrono::steady_clock;

/// A client's connection. One thread at a time owns it: the reception while a head comes, a lane
/// while the request is worked on, the delivery while the answer goes out.
struct Connection {
    /// @param admitted by `hosts`, which it leaves at its end
    Connection(Descriptor admitted, std::string from, Guests& hosts)
        : socket(std::move(admitted)), address(std::move(from)), guests(hosts) {}
    ~Connection() { guests.leave(socket.get(), address); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// True when the client has closed its side.
    [[nodiscard]] bool abandoned() const;
    /// Throws away what the client has not taken: closed as usual, the system would go on holding
    /// it, and the client would see an answer that seems to be whole.
    void give_up() const;

    Descriptor socket;    ///< never blocks
    std::string address;  ///< as limits see it: of IPv6 the network
    Guests& guests;
    std::string input;         ///< received and not yet used
    std::uint64_t served = 0;  ///< requests
};

using ConnectionPtr = std::unique_ptr<Connection>;

/// A request whose head is complete.
struct Arrival {
    ConnectionPtr connection;
    Head head;
};

/// Waits until `events` of poll() happen. @returns false at the deadline
bool wait_for(int socket, short events, Clock::time_point deadline);

/// Sends what the socket takes at once, and removes it from the front of `text`.
/// @returns false if the client is gone
bool send_some(int socket, std::string_view& text);

/// The address as limits see it: whoever has an IPv6 network has all of its addresses.
[[nodiscard]] std::string address_for_limits(const sockaddr_storage& peer);

}  // namespace lpf::http
