#include "server/site/site.h"

#include "server/ids.h"
#include "server/requests/answer.h"

namespace lpf::server {
namespace {

// Nothing that the service sends is a page, but for the web page, which brings its own policy.
constexpr const char* kNoPage = "default-src 'none'; frame-ancestors 'none'";

/// What every answer tells browsers: take it for what it says it is, and keep it to yourself.
void set_safe_headers(http::Response& response) {
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("X-Frame-Options", "DENY");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    if (!response.header("Content-Security-Policy"))
        response.set("Content-Security-Policy", kNoPage);
    if (!response.header("Cache-Control")) response.set("Cache-Control", "no-store");
}

/// An event stream that is counted for as long as it lasts.
class CountedFeed : public http::Feed {
public:
    CountedFeed(std::shared_ptr<http::Feed> feed, Telemetry& telemetry)
        : feed_(std::move(feed)), telemetry_(telemetry) {
        telemetry_.add_event_streams(1);
    }
    ~CountedFeed() override { telemetry_.add_event_streams(-1); }
    CountedFeed(const CountedFeed&) = delete;
    CountedFeed& operator=(const CountedFeed&) = delete;

    std::string next() override { return feed_->next(); }
    [[nodiscard]] bool ended() const override { return feed_->ended(); }

private:
    std::shared_ptr<http::Feed> feed_;
    Telemetry& telemetry_;
};

}  // namespace

Site::Site(Services& services, Gate* gate, Router router, http::ListenerOptions options)
    : services_(services),
      gate_(gate),
      router_(std::move(router)),
      listener_(
          std::move(options), [this](http::Request& request) { return answer(request); },
          [this](const Problem& problem) { return refuse(problem); }) {}

http::Response Site::answer(http::Request& request) {
    const auto start = Clock::now();
    if (request.id.empty()) request.id = new_id();
    const auto route = [&] {
        return router_.handle(request, [&](const std::string& text) {
            services_.log.error("request-failed", {{"request", request.id}, {"error", text}});
        });
    };
    http::Response response = gate_ ? gate_->pass(request, route) : route();
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
    set_safe_headers(response);
    if (response.feed)
        response.feed = std::make_shared<CountedFeed>(response.feed, services_.telemetry);
    const std::string route = request.route.empty() ? "none" : request.route;
    const std::uint64_t sent = request.method == "HEAD" ? 0 : response.length();
    services_.telemetry.count_request(request.method, route, response.status, sent, seconds);
    if (!response.problem.empty()) services_.telemetry.count_problem(response.problem);
    services_.log.info("request", {{"request", request.id},
                                   {"method", request.method},
                                   {"route", route},
                                   {"status", response.status},
                                   {"bytes", static_cast<std::int64_t>(sent)},
                                   {"seconds", seconds},
                                   {"key", request.key},
                                   {"problem", response.problem}});
    return response;
}

}  // namespace lpf::server
