#include "api/openapi.h"

#include <nlohmann/json.hpp>

#include "api/choices.h"
#include "api/job.h"
#include "api/openapi/parts.h"
#include "api/openapi/paths.h"
#include "api/openapi/schemas.h"
#include "api/parameters.h"

namespace lpf {
namespace {

using openapi::Json;

Json parameter(std::string_view name, std::string_view place, std::string_view description,
               const Json& schema) {
    Json result = {{"name", name}, {"in", place}, {"description", description}, {"schema", schema}};
    if (place == "path") result["required"] = true;
    return result;
}

Json input_parameters(const Limits& limits) {
    Json parameters;
    for (const Parameter& row : parameter_table(limits)) {
        parameters[std::string(row.name)] =
            parameter(row.name, "query", row.description, parameter_schema(row));
    }
    return parameters;
}

Json path_parameters() {
    std::vector<std::string_view> processes;
    for (const Task task : all_tasks()) processes.push_back(process_id(task));
    return {{"processID",
             parameter("processID", "path", "The process.", openapi::one_of("", processes))},
            {"jobID", parameter("jobID", "path", "ID of the job.", openapi::id(""))},
            {"shapeID", parameter("shapeID", "path", "ID of the shape.", openapi::id(""))},
            {"dictionaryID",
             parameter("dictionaryID", "path", "ID of the dictionary.", openapi::id(""))}};
}

Json list_parameters(const Limits& limits) {
    std::vector<std::string_view> processes;
    for (const Task task : all_tasks()) processes.push_back(process_id(task));
    Json limit = openapi::integer("", 1);
    limit["maximum"] = limits.page_items;
    return {{"jobStatus", parameter("status", "query", "Only jobs in this state.",
                                    openapi::component("Status"))},
            {"jobProcess", parameter("processID", "query", "Only jobs of this process.",
                                     openapi::one_of("", processes))},
            {"limit", parameter("limit", "query", "Items on a page.", limit)},
            {"cursor", parameter("cursor", "query", "From the link `next` of the page before.",
                                 openapi::text(""))}};
}

Json header_parameters(const Limits& limits) {
    return {{"preferWait", parameter("Prefer", "header",
                                     "`wait=N` waits for the job to end, N seconds and " +
                                         std::to_string(limits.wait_seconds) + " at most.",
                                     openapi::text(""))},
            {"idempotencyKey",
             parameter("Idempotency-Key", "header",
                       "A name for this request, such as a random UUID: sent again with the same "
                       "name it makes no second job, but gets the first answer again.",
                       openapi::text(""))},
            {"range", parameter("Range", "header", "One range of bytes, such as `bytes=0-1023`.",
                                openapi::text(""))},
            {"ifNoneMatch", parameter("If-None-Match", "header",
                                      "ETag of the copy that the client has.", openapi::text(""))},
            {"pointsFormat",
             parameter("format", "query", "Format to send. Without it, the Accept header decides.",
                       openapi::one_of("", choice_names<FileFormat>()))},
            {"dictionaryFormat", parameter("format", "query", "Format to send.",
                                           openapi::one_of("", {"json", "npy"}))}};
}

Json parameters(const Limits& limits) {
    Json all = input_parameters(limits);
    all.update(path_parameters());
    all.update(list_parameters(limits));
    all.update(header_parameters(limits));
    all.update(openapi::live_parameters());
    return all;
}

Json header(std::string_view description, const Json& schema) {
    return {{"description", description}, {"schema", schema}};
}

Json headers() {
    return {
        {"Location", header("Path of what was made.", openapi::text(""))},
        {"Retry-After", header("Seconds to wait before the next try.", openapi::integer("", 0))},
        {"X-Request-Id",
         header("Names the request in problems and in the server's log; the client's own, if it "
                "sent one of up to 64 letters, digits, '-', '_' or '.'.",
                openapi::text(""))},
        {"WWW-Authenticate", header("How to show a key.", openapi::text(""))},
        {"RateLimit-Limit", header("Requests in a full bucket.", openapi::integer("", 0))},
        {"RateLimit-Remaining", header("Requests left in it.", openapi::integer("", 0))},
        {"RateLimit-Reset", header("Seconds until it is full again.", openapi::integer("", 0))},
        {"ETag", header("Stands for exactly these bytes.", openapi::text(""))},
        {"Accept-Ranges", header("Ranges of bytes are served.", openapi::text(""))},
        {"Content-Range",
         header("The bytes that were sent, and how many there are.", openapi::text(""))},
        {"Content-Disposition", header("A name for the file.", openapi::text(""))},
        {"Preference-Applied", header("The preference that was followed.", openapi::text(""))},
        {"Idempotency-Replayed",
         header("`true`: the same request made this job before.", openapi::one_of("", {"true"}))},
        {"Link", header("The job (`rel=monitor`) whose result this is.", openapi::text(""))}};
}

Json tags() {
    const auto tag = [](std::string_view name, std::string_view description) {
        return Json{{"name", name}, {"description", description}};
    };
    return {tag("Service", "What the service is."),
            tag("Processes", "What it can do, and starting it."),
            tag("Shapes", "Uploaded point clouds and meshes."),
            tag("Jobs", "What it is doing."),
            tag("Results", "What came out."),
            tag("Dictionaries", "What was learned."),
            tag("Operation", "For those who run it.")};
}

}  // namespace

nlohmann::json openapi_document(const Limits& limits, std::string_view version,
                                std::string_view server_url) {
    if (server_url.size() > 1 && server_url.ends_with('/')) server_url.remove_suffix(1);
    Json all_headers = headers();
    all_headers.update(openapi::live_headers());
    Json schemas = openapi::service_schemas(limits);
    schemas.update(openapi::result_schemas());
    schemas.update(openapi::live_schemas());
    const Json key = {{"type", "http"},
                      {"scheme", "bearer"},
                      {"description", "An API key, where the service was started with keys."}};
    return {{"openapi", "3.1.0"},
            {"info",
             {{"title", "LPF Server"},
              {"version", version},
              {"summary", "Denoises, resamples and analyses 3D shapes"},
              {"description",
               "Point clouds and triangle meshes, PLY or Draco, are denoised, resampled and "
               "analysed with Local Probing Fields. A shape is uploaded, a job runs, its results "
               "are fetched."},
              {"license", {{"name", "Apache License 2.0"}, {"identifier", "Apache-2.0"}}}}},
            {"servers", Json::array({{{"url", server_url}}})},
            {"security", Json::array({Json::object(), {{"apiKey", Json::array()}}})},
            {"tags", tags()},
            {"paths", openapi::paths(limits)},
            {"components",
             {{"schemas", std::move(schemas)},
              {"parameters", parameters(limits)},
              {"headers", std::move(all_headers)},
              {"securitySchemes", {{"apiKey", key}}}}}};
}

}  // namespace lpf
