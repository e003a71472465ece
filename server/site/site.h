#pragma once

#include "server/gate/gate.h"
#include "server/http/listener.h"
#include "server/services.h"
#include "server/site/router.h"

namespace lpf::server {

/// A listener with its routes: every answer carries the request's id and the safe defaults, every
/// request leaves a line in the log and is counted.
class Site {
public:
    /// @param gate stands before the routes; may be null, for a listener that nobody else reaches
    Site(Services& services, Gate* gate, Router router, http::ListenerOptions options);

    int start() { return listener_.start(); }
    void stop(std::chrono::milliseconds patience) { listener_.stop(patience); }

private:
    [[nodiscard]] http::Response answer(http::Request& request);
    [[nodiscard]] http::Response refuse(const Problem& problem);
    [[nodiscard]] http::Response finish(http::Response response, const http::Request& request,
                                        double seconds);

    Services& services_;
    Gate* gate_;
    Router router_;
    http::Listener listener_;
};

}  // namespace lpf::server
