#include "server/site.h"

#include "server/answer.h"
#include "server/ids.h"

namespace lpf::server {

Site::Site(Services& services, Router router, http::ListenerOptions options)
    : services_(services),
      router_(std::move(router)),
      listener_(
          std::move(options), [this](http::Request& request) { return answer(request); },
          [this](const Problem& problem) { return refuse(problem); }) {}

http::Response Site::answer(http::Request& request) {
    const auto start = Clock::now();
    if (request.id.empty()) request.id = new_id();
    http::Response response = router_.handle(request, [&](const std::string& text) {
        services_.log.error("request-failed", {{"request", request.id}, {"error", text}});
    });
    return finish(std::move(response), request, seconds_since(start));
}

http::Response Site::refuse(const Problem& problem) {
    http::Request request;
    request.method = "-";
    request.id = new_id();
    return finish(problem_response(problem, request), request, 0.0);
}

http::Response Site::finish(http::Response response, const http::Request& request, double seconds) {
    response.set("X-Request-Id", request.id);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    if (!response.header("Cache-Control")) response.set("Cache-Control", "no-store");
    const std::string route = request.route.empty() ? "none" : request.route;
    const std::uint64_t sent = request.method == "HEAD" ? 0 : response.length();
    services_.telemetry.count_request(request.method, route, response.status, sent, seconds);
    services_.log.info("request", {{"request", request.id},
                                   {"method", request.method},
                                   {"route", route},
                                   {"status", response.status},
                                   {"bytes", static_cast<std::int64_t>(sent)},
                                   {"seconds", seconds}});
    return response;
}

}  // namespace lpf::server
