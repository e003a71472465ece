#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "api/limits.h"

namespace lpf::http {

/// Who is connected: how many in all and from each address, and the means to cut everybody off. Any
/// number of threads may call.
class Guests {
public:
    enum class Admission { Granted, HouseFull, ClientFull, NoRoomAtAll };

    explicit Guests(const Limits& limits);

    /// Counts a connection, also one that is only let in to be told that there is no room; but for
    /// NoRoomAtAll, which is to be closed without a word.
    Admission enter(int socket, const std::string& address);
    /// Before the socket is closed.
    void leave(int socket, const std::string& address);

    /// @returns false if somebody was still there after `patience`
    bool wait_until_empty(std::chrono::milliseconds patience);
    /// Ends every connection; whoever works on one learns it from the socket.
    void cut_all();

private:
    std::uint64_t most_;
    std::uint64_t most_per_address_;  // 0: no limit
    std::mutex mutex_;
    std::condition_variable changed_;
    std::set<int> sockets_;
    std::map<std::string, std::uint64_t> addresses_;
};

/// Raises the limit of open files to what the system grants. @returns the limit
std::uint64_t raise_descriptor_limit();

}  // namespace lpf::http
