#include "api/service_info.h"

#include <nlohmann/json.hpp>

#include "api/codec/format.h"
#include "api/link.h"

namespace lpf {
namespace {

using nlohmann::json;

json link(const std::string& href, const std::string& rel, const std::string& title,
          const std::string& type = "application/json") {
    return to_json(Link{.href = href, .rel = rel, .type = type, .title = title});
}

json formats() {
    json result = json::array();
    for (const FileFormat format : all_formats()) {
        result.push_back({{"name", format_name(format)},
                          {"mediaType", media_type(format)},
                          {"extension", file_extension(format)}});
    }
    return result;
}

}  // namespace

json landing_page() {
    const std::string ogc = "http://www.opengis.net/def/rel/ogc/1.0/";
    return {{"title", "LPF Server"},
            {"description",
             "Denoises, resamples and analyses point clouds and meshes with Local Probing Fields."},
            {"links",
             {link("/v1/", "self", "This document"),
              link("/v1/openapi.json", "service-desc", "The API as OpenAPI 3.1",
                   "application/vnd.oai.openapi+json;version=3.1"),
              link("/v1/conformance", ogc + "conformance", "What this service conforms to"),
              link("/v1/processes", ogc + "processes", "What it can do"),
              link("/v1/jobs", ogc + "job-list", "What it is doing"),
              link("/v1/dictionaries", "related", "Dictionaries that jobs have learned"),
              link("/v1/info", "related", "Version, limits, formats, queue and retention")}}};
}

json conformance() {
    const std::string ogc = "http://www.opengis.net/spec/ogcapi-processes-1/1.0/conf/";
    return {{"conformsTo",
             {ogc + "core", ogc + "json", ogc + "job-list", ogc + "dismiss",
              ogc + "ogc-process-description"}}};
}

json service_info(const ServiceState& state, const Limits& limits) {
    return {{"name", "LPF Server"},
            {"version", state.version},
            {"limits", to_json(limits)},
            {"formats", formats()},
            {"queue",
             {{"queued", state.queued},
              {"running", state.running},
              {"capacity", limits.queued_jobs},
              {"workers", state.workers},
              {"threadsPerJob", state.threads_per_job}}},
            {"retention",
             {{"resultSeconds", limits.result_retention_seconds},
              {"statusSeconds", limits.status_retention_seconds}}},
            {"uptimeSeconds", state.uptime_seconds},
            {"authentication", state.authentication}};
}

}  // namespace lpf
