#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.h"

namespace lpf::gate {

/// Which web pages may talk to the service (CORS). A page of the service itself always may; any
/// other only if its origin was named.
class Origins {
public:
    /// @param allowed "https://pages.example" each, or "*" for every page there is
    /// @param local the service is for this machine only: names that a stranger's DNS could point
    ///        at it are not its own
    /// @throws Error{InvalidParameter} that says what an origin looks like
    Origins(const std::vector<std::string>& allowed, bool local);

    /// Refuses what a page of somebody else's would have its visitor's browser do: every browser
    /// names the page with such a request, but sends it all the same.
    /// @throws ProblemException{Forbidden}
    void check(const http::Request& request) const;

    /// Adds what a browser needs to hand the answer to the page, if the page may have it.
    void dress(const http::Request& request, http::Response& response) const;

private:
    [[nodiscard]] bool allows(const std::string& origin) const;
    [[nodiscard]] bool is_own_host(std::string_view host) const;

    std::vector<std::string> allowed_;
    bool any_ = false;
    bool local_ = false;
};

}  // namespace lpf::gate
