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

struct ListenerOptions {
    std::string host = "127.0.0.1";
    int port = 0;              ///< 0 picks a free one
    std::size_t threads = 16;  ///< requests served at a time
    std::size_t queue = 256;   ///< connections that wait for a thread; more are answered 503
    Limits limits = {};
    std::chrono::seconds head_deadline{10};  ///< for a whole head
    std::chrono::seconds write_stall{30};    ///< between two pieces of an answer
};

/// Answers a request; must not throw.
using Handler = std::function<Response(Request&)>;
/// Makes the answer to a request that never reached a handler; must not throw.
using RefusalHandler = std::function<Response(const Problem&)>;

/// A listening socket with threads of its own. One request a connection: what is left unread of a
/// body can then never be taken for the next request. The only owner of cpp-httplib.
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
    class Server;
    std::unique_ptr<Server> server_;
};

}  // namespace lpf::http
