#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/config.h"
#include "server/gate/api_keys.h"
#include "server/gate/origins.h"
#include "server/gate/peer.h"
#include "server/gate/rate_limiter.h"
#include "server/http/message.h"
#include "server/log.h"

namespace lpf::server {

/// What stands before the handlers: who asks, from which page, and how often.
class Gate {
public:
    /// @throws Error{InvalidParameter} when the configuration cannot be used
    Gate(const Config& config, Log& log);

    /// Lets the request through to `next`, which must not throw, or answers it itself. Sets the
    /// client and the key of the request.
    [[nodiscard]] http::Response pass(http::Request& request,
                                      const std::function<http::Response()>& next);

    /// Reads the key file again. A wrong one changes nothing and is named in the log.
    void reload();

private:
    using Verdict = gate::RateLimiter::Verdict;

    /// @throws ProblemException{Forbidden, Unauthorized, RateLimited}
    void admit(http::Request& request, Verdict& verdict);
    void find_client(http::Request& request, bool& local) const;
    void find_key(http::Request& request) const;
    void count(const std::string& who, bool upload, Verdict& verdict);

    Log& log_;
    std::unique_ptr<gate::KeyFile> keys_;  // empty: the service is open
    gate::TrustedProxies proxies_;
    gate::Origins origins_;
    gate::RateLimiter requests_;
    gate::RateLimiter uploads_;
};

}  // namespace lpf::server
