#include "api/openapi/paths.h"

#include <nlohmann/json.hpp>

#include "api/openapi/parts.h"

namespace lpf::openapi {
namespace {

using P = ProblemCode;

constexpr std::string_view kAdminServer = "http://127.0.0.1:8081";

Json document_paths() {
    const Json openapi = {{"type", "object"}, {"description", "An OpenAPI 3.1 document."}};
    const Json content = {{"application/vnd.oai.openapi+json", {{"schema", openapi}}}};
    Json paths;
    paths["/v1/"]["get"] =
        Operation("getLandingPage", "Service", "Landing page")
            .answers(200, "Links to everything.", json_content(component("LandingPage")))
            .json();
    paths["/v1"]["get"] =
        Operation("getLandingPageToo", "Service", "The same landing page")
            .answers(200, "Links to everything.", json_content(component("LandingPage")))
            .json();
    paths["/v1/conformance"]["get"] =
        Operation("getConformance", "Service", "Conformance classes")
            .answers(200, "What the service conforms to.", json_content(component("Conformance")))
            .json();
    paths["/v1/openapi.json"]["get"] = Operation("getOpenApi", "Service", "This document")
                                           .answers(200, "The document.", content)
                                           .json();
    paths["/v1/info"]["get"] =
        Operation("getInfo", "Service", "Version, limits, formats, queue and retention")
            .answers(200, "The running service.", json_content(component("Info")))
            .json();
    return paths;
}

Json process_paths() {
    Json paths;
    paths["/v1/processes"]["get"] =
        Operation("listProcesses", "Processes", "What the service can do")
            .answers(200, "All processes.", json_content(component("ProcessList")))
            .json();
    paths["/v1/processes/{processID}"]["get"] =
        Operation("getProcess", "Processes", "One process",
                  "Every input with its JSON Schema: default, unit, range, what `auto` does.")
            .parameter("processID")
            .answers(200, "The process.", json_content(component("Process")))
            .fails({P::ProcessNotFound})
            .json();
    return paths;
}

Json upload_operation() {
    Json content = file_content(
        {"application/octet-stream", "application/ply", "application/vnd.draco", "*/*"});
    const Json file = {{"type", "string"}, {"contentMediaType", "application/octet-stream"}};
    content["multipart/form-data"] = {{"schema", object("A form.", {{"file", file}})}};
    return Operation(
               "uploadShape", "Shapes", "Upload a shape",
               "The body is the file itself, PLY or Draco; the content decides, not the media "
               "type.")
        .body("The file.", content)
        .answers(201, "Stored.", json_content(component("Shape")), {"Location"})
        .answers(200, "The same bytes were stored already.", json_content(component("Shape")),
                 {"Location"})
        .fails({P::LengthRequired, P::PayloadTooLarge, P::LimitExceeded, P::UnsupportedFormat,
                P::MalformedFile, P::UndecodableFile, P::InsufficientStorage})
        .json();
}

Json shape_paths() {
    Json paths;
    paths["/v1/shapes"]["post"] = upload_operation();
    const Operation get = Operation("getShape", "Shapes", "Describe a shape")
                              .parameter("shapeID")
                              .answers(200, "The shape.", json_content(component("Shape")))
                              .fails({P::ShapeNotFound});
    paths["/v1/shapes/{shapeID}"]["get"] = get.json();
    paths["/v1/shapes/{shapeID}"]["head"] = get.head();
    paths["/v1/shapes/{shapeID}"]["delete"] = Operation("deleteShape", "Shapes", "Delete a shape")
                                                  .parameter("shapeID")
                                                  .answers(204, "Deleted.")
                                                  .fails({P::ShapeNotFound, P::ShapeInUse})
                                                  .json();
    const Operation data =
        Operation("getShapeData", "Shapes", "The file as it was uploaded")
            .parameter("shapeID")
            .parameter("range")
            .parameter("ifNoneMatch")
            .answers(200, "The file.", file_content({"application/ply", "application/vnd.draco"}),
                     {"ETag", "Accept-Ranges", "Content-Disposition"})
            .answers(206, "A part of it.",
                     file_content({"application/ply", "application/vnd.draco"}),
                     {"ETag", "Content-Range"})
            .answers(304, "It has not changed.", {}, {"ETag"})
            .fails({P::ShapeNotFound, P::RangeNotSatisfiable});
    paths["/v1/shapes/{shapeID}/data"]["get"] = data.json();
    paths["/v1/shapes/{shapeID}/data"]["head"] = data.head();
    return paths;
}

Json dictionary_paths() {
    Json paths;
    paths["/v1/dictionaries"]["get"] =
        Operation("listDictionaries", "Dictionaries", "Dictionaries that jobs have learned")
            .parameter("limit")
            .parameter("cursor")
            .answers(200, "A page of dictionaries.", json_content(component("DictionaryList")))
            .fails({P::InvalidParameter})
            .json();
    paths["/v1/dictionaries/{dictionaryID}"]["get"] =
        Operation("getDictionary", "Dictionaries", "Describe a dictionary")
            .parameter("dictionaryID")
            .answers(200, "The dictionary.", json_content(component("DictionarySummary")))
            .fails({P::DictionaryNotFound})
            .json();
    Json content = json_content(component("Dictionary"));
    content.update(file_content({"application/octet-stream"}));
    paths["/v1/dictionaries/{dictionaryID}/data"]["get"] =
        Operation("getDictionaryData", "Dictionaries", "Pattern points and atoms",
                  "JSON with everything, or the atoms as a NumPy file: float32, (d, M, 3).")
            .parameter("dictionaryID")
            .parameter("dictionaryFormat")
            .parameter("range")
            .parameter("ifNoneMatch")
            .answers(200, "The dictionary.", content,
                     {"ETag", "Accept-Ranges", "Content-Disposition"})
            .answers(206, "A part of it.", content, {"ETag", "Content-Range"})
            .answers(304, "It has not changed.", {}, {"ETag"})
            .fails({P::DictionaryNotFound, P::InvalidParameter, P::RangeNotSatisfiable})
            .json();
    return paths;
}

/// A question to the running process that needs no key. `refusal` is its 503, if it has one.
Json probe(std::string_view id, std::string_view summary, const Json& content,
           const Json& refusal = {}) {
    Json operation =
        Operation(id, "Operation", summary).open_to_all().answers(200, "Yes.", content).json();
    if (!refusal.is_null()) {
        operation["responses"]["503"] = {{"description", "Not now."}, {"content", refusal}};
    }
    return operation;
}

Json text_content(std::string_view media_type) {
    return {{std::string(media_type), {{"schema", {{"type", "string"}}}}}};
}

Json operation_paths() {
    const Json admin = Json::array(
        {{{"url", kAdminServer}, {"description", "The admin listener, where it is by default."}}});
    const Json health = object("", {{"status", one_of("", {"ok"})}, {"version", text("")}});
    const Json ready = object("", {{"status", one_of("", {"ready"})}});
    const Json not_ready =
        object("", {{"status", one_of("", {"not-ready"})}, {"reason", text("Why not.")}});
    Json paths;
    paths["/healthz"]["get"] = probe("getHealth", "Is the process alive?", json_content(health));
    paths["/readyz"]["get"] =
        probe("getReadiness", "Does it take work?", json_content(ready), json_content(not_ready));
    paths["/metrics"]["get"] =
        probe("getMetrics", "Figures for Prometheus", text_content("text/plain"));
    paths["/readyz"]["servers"] = admin;
    paths["/metrics"]["servers"] = admin;
    paths["/"]["get"] = probe("getWebPage", "The web page", text_content("text/html"));
    paths["/"]["get"]["responses"]["404"] = {
        {"description", "The server was started without a web page."},
        {"content", {{std::string(kProblemMediaType), {{"schema", component("Problem")}}}}}};
    return paths;
}

}  // namespace

Json paths(const Limits& limits) {
    Json all = document_paths();
    for (const Json& some : {process_paths(), execution_paths(limits), live_paths(limits),
                             shape_paths(), job_paths(), dictionary_paths(), operation_paths()}) {
        all.update(some);
    }
    return all;
}

}  // namespace lpf::openapi
