#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/http/message.h"

namespace lpf::server {

using RouteHandler = std::function<http::Response(http::Request&)>;

/// One line of the route table. In the pattern, {name} stands for one segment of the path.
struct Route {
    std::string method;
    std::string pattern;
    RouteHandler handler;
};

/// Finds the handler of a request. HEAD is answered by the handler of GET; OPTIONS by the table
/// itself.
class Router {
public:
    /// @param fallback answers GET requests for paths that the table does not know; may be empty
    explicit Router(std::vector<Route> routes, RouteHandler fallback = {});

    /// Never throws: every exception becomes a problem document.
    /// @param report hears of exceptions that are defects, with their text, for the log
    [[nodiscard]] http::Response handle(
        http::Request& request, const std::function<void(const std::string&)>& report) const;

private:
    [[nodiscard]] http::Response dispatch(http::Request& request) const;

    std::vector<Route> routes_;
    RouteHandler fallback_;
};

}  // namespace lpf::server
