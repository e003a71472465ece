// Paths that tell of a job before it runs and while it does: validate, events, preview.
#include <nlohmann/json.hpp>

#include "api/openapi/examples.h"
#include "api/openapi/parts.h"
#include "api/openapi/paths.h"
#include "api/parameters.h"

namespace lpf::openapi {
namespace {

Json parameter(std::string_view name, std::string_view place, std::string_view description,
               const Json& schema) {
    return {{"name", name}, {"in", place}, {"description", description}, {"schema", schema}};
}

using P = ProblemCode;

Json validation(Task task, const Limits& limits) {
    const std::string id(process_id(task));
    const std::string name = schema_prefix(task);
    Operation operation("validate" + name, "Processes", "Foresee a job: " + id,
                        "Takes what an execution takes, and queues and keeps nothing. Tells the "
                        "parameters that `auto` comes to, what becomes of each attribute, how long "
                        "the job would take and how much memory, and what to beware of.");
    for (const Parameter& parameter : parameters_of(task, limits)) {
        operation.parameter(parameter.name);
    }
    return operation.body("The shape.", shape_body(task))
        .answers(200, "What the job would do.",
                 json_content(component("Validation"), validation_example(task)))
        .fails({P::MalformedJson,      P::InvalidParameter,     P::Unprocessable,
                P::TooFewPoints,       P::DegenerateShape,      P::IncompatibleDictionary,
                P::MalformedFile,      P::UndecodableFile,      P::TimedOut,
                P::LimitExceeded,      P::PayloadTooLarge,      P::LengthRequired,
                P::UnsupportedFormat,  P::UnsupportedMediaType, P::ShapeNotFound,
                P::DictionaryNotFound, P::ProcessNotFound,      P::InsufficientStorage,
                P::StorageFailure,     P::OutOfMemory})
        .json();
}

Json events() {
    const Json stream = {
        {"type", "string"},
        {"description",
         "Server-sent events. `status`: the job has a new status (data: StatusInfo). `progress`: "
         "it "
         "has come further, at least every second while it runs (JobProgress). `log`: something to "
         "know (JobLog). `end`: nothing more will come (StatusInfo)."},
        {"contentMediaType", "text/event-stream"},
        {"contentSchema", component("JobEvent")}};
    Json operation =
        Operation("getJobEvents", "Jobs", "Follow a job",
                  "Begins with what happened so far, or after the event that Last-Event-ID names, "
                  "and ends with the job. Event ids grow, over restarts of the server too. Older "
                  "`progress` events are not told again.")
            .parameter("jobID")
            .parameter("lastEventIdHeader")
            .parameter("lastEventId")
            .answers(200, "The story of the job.", {}, {"Cache-Control", "X-Accel-Buffering"})
            .answers(204, "The job has ended, and the client has its last event: do not come back.")
            .fails({P::JobNotFound, P::JobDismissed, P::JobExpired, P::InvalidParameter})
            .json();
    operation["responses"]["200"]["content"]["text/event-stream"] = {{"schema", stream},
                                                                     {"example", events_example()}};
    return operation;
}

Operation preview(const char* id, const char* summary, const char* description) {
    return Operation(id, "Results", summary, description)
        .answers(200, "Points as binary PLY: float32 x y z, uchar red green blue if there are any.",
                 file_content({"application/ply"}),
                 {"ETag", "Accept-Ranges", "Content-Disposition", "Preview-Of", "Preview-Points",
                  "Preview-Total-Points", "Preview-Offset"})
        .answers(206, "A part of it.", file_content({"application/ply"}), {"ETag", "Content-Range"})
        .answers(304, "It has not changed.", {}, {"ETag"})
        .parameter("maxPoints")
        .parameter("range")
        .parameter("ifNoneMatch")
        .fails({P::InvalidParameter, P::ShapeNotFound, P::RangeNotSatisfiable, P::OutOfMemory,
                P::UndecodableFile});
}

}  // namespace

std::string schema_prefix(Task task) {
    std::string name(process_id(task));
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    return name;
}

Json shape_body(Task task) {
    const std::string name = schema_prefix(task);
    Json content = file_content(
        {"application/octet-stream", "application/ply", "application/vnd.draco", "*/*"});
    content["application/json"] = {{"schema", component(name + "Request")},
                                   {"example", execution_example()}};
    content["multipart/form-data"] = {{"schema", component(name + "Form")}};
    return content;
}

Json live_parameters() {
    Json most = integer("", 1);
    most["maximum"] = 2'000'000;
    most["default"] = 200'000;
    Json event = integer("", 0);
    return {
        {"maxPoints", parameter("maxPoints", "query", "Points to show, at most.", most)},
        {"previewOf", parameter("of", "query",
                                "What to show. Without it: the result if there "
                                "is one, else the input.",
                                one_of("", {"input", "result"}))},
        {"lastEventId",
         parameter("lastEventId", "query", "The same for clients that cannot set headers.", event)},
        {"lastEventIdHeader",
         parameter("Last-Event-ID", "header",
                   "Id of the last event that the client has; EventSource sends it.", text(""))}};
}

Json live_headers() {
    const auto header = [](std::string_view description, const Json& schema) {
        return Json{{"description", description}, {"schema", schema}};
    };
    return {{"Cache-Control", header("An event stream is never kept.", text(""))},
            {"X-Accel-Buffering", header("`no`: a proxy passes on each event at once.", text(""))},
            {"Preview-Of", header("What is shown.", one_of("", {"input", "result"}))},
            {"Preview-Points", header("Points in this file.", integer(""))},
            {"Preview-Total-Points", header("Points of the whole.", integer(""))},
            {"Preview-Offset",
             header("Three numbers, to be added to x, y and z. Also a comment in the file: `offset "
                    "x y z`. Zero where float32 holds the coordinates well enough.",
                    text(""))}};
}

Json live_paths(const Limits& limits) {
    Json paths;
    for (const Task task : all_tasks()) {
        const std::string path = "/v1/processes/" + std::string(process_id(task)) + "/validate";
        paths[path]["post"] = validation(task, limits);
    }
    paths["/v1/jobs/{jobID}/events"]["get"] = events();
    Operation of_job =
        preview("getJobPreview", "A fair share of the points of a job, to draw",
                "Of the result if there is one, else of the input, which is there from the start.");
    of_job.parameter("jobID")
        .parameter("previewOf")
        .fails({P::JobNotFound, P::JobDismissed, P::JobExpired, P::ResultNotReady,
                P::ResultNotFound, P::TooFewPoints, P::DegenerateShape, P::MalformedFile,
                P::TimedOut, P::IncompatibleDictionary, P::LimitExceeded, P::UnsupportedFormat,
                P::WorkerLost, P::InsufficientStorage});
    paths["/v1/jobs/{jobID}/preview"]["get"] = of_job.json();
    paths["/v1/jobs/{jobID}/preview"]["head"] = of_job.head();
    Operation of_shape = preview("getShapePreview", "A fair share of the points of a shape", "");
    of_shape.parameter("shapeID");
    paths["/v1/shapes/{shapeID}/preview"]["get"] = of_shape.json();
    paths["/v1/shapes/{shapeID}/preview"]["head"] = of_shape.head();
    return paths;
}

}  // namespace lpf::openapi
