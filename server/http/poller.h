#pragma once

#include <sys/epoll.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "server/http/descriptor.h"

namespace lpf::http {

/// Waits for many sockets at once; another thread can end a wait.
class Poller {
public:
    /// @throws Error{StorageFailure} when the system grants no descriptor
    Poller();

    void add(int socket, std::uint32_t events);
    void remove(int socket);

    /// Sockets with something to do, at most a few hundred; empty when the time is over or
    /// `wake` was called.
    [[nodiscard]] std::vector<int> wait(std::chrono::milliseconds time);
    void wake();

private:
    Descriptor poll_;
    Descriptor bell_;
};

}  // namespace lpf::http
