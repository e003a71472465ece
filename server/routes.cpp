#include "server/routes.h"

#include "server/handlers/handlers.h"

namespace lpf::server {

Router public_routes(Services& services) {
    const auto to = [&services](auto handler) -> RouteHandler {
        return [&services, handler](http::Request& request) { return handler(services, request); };
    };
    return Router(
        {
            {"GET", "/v1", to(get_landing_page)},
            {"GET", "/v1/", to(get_landing_page)},
            {"GET", "/v1/conformance", to(get_conformance)},
            {"GET", "/v1/openapi.json", to(get_openapi)},
            {"GET", "/v1/info", to(get_info)},

            {"GET", "/v1/processes", to(list_processes)},
            {"GET", "/v1/processes/{id}", to(get_process)},
            {"POST", "/v1/processes/{id}/execution", to(execute_process)},
            {"POST", "/v1/processes/{id}/validate", to(validate_process)},

            {"POST", "/v1/shapes", to(upload_shape)},
            {"GET", "/v1/shapes/{id}", to(get_shape)},
            {"DELETE", "/v1/shapes/{id}", to(delete_shape)},
            {"GET", "/v1/shapes/{id}/data", to(get_shape_data)},
            {"GET", "/v1/shapes/{id}/preview", to(get_shape_preview)},

            {"GET", "/v1/jobs", to(list_jobs)},
            {"GET", "/v1/jobs/{id}", to(get_job)},
            {"DELETE", "/v1/jobs/{id}", to(dismiss_job)},
            {"GET", "/v1/jobs/{id}/events", to(get_events)},
            {"GET", "/v1/jobs/{id}/preview", to(get_job_preview)},
            {"POST", "/v1/jobs/{id}/retry", to(retry_job)},
            {"GET", "/v1/jobs/{id}/results", to(list_results)},
            {"GET", "/v1/jobs/{id}/results/points", to(get_points)},
            {"GET", "/v1/jobs/{id}/results/dictionary", to(get_dictionary_result)},
            {"GET", "/v1/jobs/{id}/results/report", to(get_report)},
            {"GET", "/v1/jobs/{id}/results/fields", to(get_fields)},

            {"GET", "/v1/dictionaries", to(list_dictionaries)},
            {"GET", "/v1/dictionaries/{id}", to(get_dictionary)},
            {"GET", "/v1/dictionaries/{id}/data", to(get_dictionary_data)},

            {"GET", "/healthz", to(get_health)},
        },
        to(get_web_file));
}

Router admin_routes(Services& services) {
    const auto to = [&services](auto handler) -> RouteHandler {
        return [&services, handler](http::Request& request) { return handler(services, request); };
    };
    return Router({
        {"GET", "/healthz", to(get_health)},
        {"GET", "/readyz", to(get_readiness)},
        {"GET", "/metrics", to(get_metrics)},
    });
}

}  // namespace lpf::server
