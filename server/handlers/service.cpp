#include <nlohmann/json.hpp>

#include "api/openapi.h"
#include "api/service_info.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"

namespace lpf::server {

http::Response get_landing_page(Services&, http::Request&) { return json_response(landing_page()); }

http::Response get_conformance(Services&, http::Request&) { return json_response(conformance()); }

http::Response get_openapi(Services& services, http::Request&) {
    http::Response response = json_response(openapi_document(services.limits(), version(), "/"));
    response.content_type = "application/vnd.oai.openapi+json;version=3.1";
    return response;
}

http::Response get_info(Services& services, http::Request&) {
    const Gauges gauges = services.queue.gauges();
    ServiceState state;
    state.version = version();
    state.queued = gauges.queued;
    state.running = gauges.running;
    state.workers = gauges.workers;
    state.threads_per_job = static_cast<std::uint64_t>(services.config.threads);
    state.uptime_seconds = static_cast<std::uint64_t>(gauges.uptime_seconds);
    state.authentication = !services.config.api_key_file.empty();
    return json_response(service_info(state, services.limits()));
}

http::Response get_health(Services&, http::Request&) {
    return json_response({{"status", "ok"}, {"version", version()}});
}

}  // namespace lpf::server
