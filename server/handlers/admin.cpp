#include <nlohmann/json.hpp>

#include "server/handlers/handlers.h"
#include "server/requests/answer.h"

namespace lpf::server {

/// Ready means: jobs are taken, and the books can be read.
http::Response get_readiness(Services& services, http::Request&) {
    std::string reason;
    try {
        if (!services.queue.gauges().ready) reason = "stopping";
    } catch (const std::exception& error) {
        services.log.error("not-ready", {{"error", error.what()}});
        reason = "storage";
    }
    if (reason.empty()) return json_response({{"status", "ready"}});
    return json_response({{"status", "not-ready"}, {"reason", reason}}, 503);
}

http::Response get_metrics(Services& services, http::Request&) {
    http::Response response;
    response.content_type = "text/plain; version=0.0.4; charset=utf-8";
    response.body = services.telemetry.text(services.queue.gauges());
    return response;
}

}  // namespace lpf::server
