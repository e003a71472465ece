#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "api/problem.h"
#include "server/http/head.h"
#include "server/http/message.h"

namespace lpf::http {

/// How long a handler takes.
enum class Pace {
    AtOnce,  ///< does not wait for anything, not even a disk: answered by the reception itself
    Quick,
    Long  ///< computes or waits: gets a bounded share of the threads
};

struct ListenerOptions {
    std::string host = "127.0.0.1";
    int port = 0;              ///< 0 picks a free one
    std::size_t threads = 16;  ///< quick requests worked on at a time
    std::size_t queue = 256;   ///< requests of a kind that wait for a thread; more are answered 503
    Limits limits = {};
    /// Of a request without a body; one with `Prefer: wait` is Long in any case.
    std::function<Pace(const Request&)> pace = [](const Request&) { return Pace::Quick; };
};

/// Answers a request; must not throw.
using Handler = std::function<Response(Request&)>;
/// Makes the answer to a request that never reached a handler; must not throw.
using RefusalHandler = std::function<Response(const Problem&)>;

/// A port with everything behind it: a reception that reads heads, lanes of threads that work on
/// requests, a delivery that sends the answers, and the event streams. Only a request that is
/// worked on holds a thread, never a client that is slow to ask or to listen; slow bodies have
/// threads of their own.
class Listener {
public:
    Listener(ListenerOptions options, Handler handler, RefusalHandler refuse);
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    /// Binds and starts to serve.
    /// @returns the port @throws Error{StorageFailure} when the address cannot be had
    int start();

    /// Stops to accept, lets requests in flight end, and cuts those that last longer than
    /// `patience`.
    void stop(std::chrono::milliseconds patience);

private:
    class House;
    std::unique_ptr<House> house_;
};

}  // namespace lpf::http
