#include <nlohmann/json.hpp>

#include "api/openapi/examples.h"
#include "api/openapi/parts.h"
#include "api/openapi/paths.h"
#include "api/parameters.h"

namespace lpf::openapi {
namespace {

using P = ProblemCode;

Json execution_body(const std::string& schema_name) {
    Json content = file_content(
        {"application/octet-stream", "application/ply", "application/vnd.draco", "*/*"});
    content["application/json"] = {{"schema", component(schema_name + "Request")},
                                   {"example", execution_example()}};
    content["multipart/form-data"] = {{"schema", component(schema_name + "Form")}};
    return content;
}

Json result_content(Task task) {
    if (task == Task::Analyze) return json_content(component("Results"));
    return file_content({"application/ply", "application/vnd.draco"});
}

Json execution(Task task, const Limits& limits) {
    const std::string id(process_id(task));
    std::string name = id;
    name[0] = static_cast<char>(name[0] - 'a' + 'A');
    Operation operation("execute" + name, "Processes", "Start a job: " + id,
                        "The body is the file itself, with the inputs in the query string; or a "
                        "form with the part `file` and the inputs as fields; or JSON that names an "
                        "uploaded shape. Every input is `auto` unless it is given.");
    operation.parameter("preferWait").parameter("idempotencyKey");
    for (const Parameter& parameter : parameters_of(task, limits)) {
        operation.parameter(parameter.name);
    }
    return operation.body("The shape.", execution_body(name))
        .answers(201, "The job is stored and will run.",
                 json_content(component("StatusInfo"), status_example(task)),
                 {"Location", "Link", "Idempotency-Replayed"})
        .answers(200,
                 task == Task::Analyze ? "The job ended within the wait: its results."
                                       : "The job ended within the wait: the points themselves.",
                 result_content(task), {"Preference-Applied", "Link", "Idempotency-Replayed"})
        .fails({P::MalformedJson,       P::InvalidParameter,    P::Unprocessable,
                P::TooFewPoints,        P::DegenerateShape,     P::IncompatibleDictionary,
                P::MalformedFile,       P::UndecodableFile,     P::TimedOut,
                P::OutOfMemory,         P::LimitExceeded,       P::PayloadTooLarge,
                P::LengthRequired,      P::UnsupportedFormat,   P::UnsupportedMediaType,
                P::ShapeNotFound,       P::DictionaryNotFound,  P::ProcessNotFound,
                P::IdempotencyConflict, P::IdempotencyMismatch, P::Unavailable,
                P::QuotaExceeded,       P::QueueFull,           P::InsufficientStorage,
                P::NotAcceptable,       P::JobDismissed,        P::StorageFailure,
                P::WorkerLost})
        .json();
}

Operation result(std::string_view name, const Json& content, bool choice_of_format) {
    std::string capital(name);
    capital[0] = static_cast<char>(capital[0] - 'a' + 'A');
    Operation operation("getJob" + capital, "Results", "The " + std::string(name) + " of a job");
    operation.parameter("jobID").parameter("range").parameter("ifNoneMatch");
    if (choice_of_format) operation.parameter("pointsFormat");
    operation
        .answers(200, "The " + std::string(name) + ".", content,
                 {"ETag", "Accept-Ranges", "Content-Disposition"})
        .answers(206, "A part of it.", content, {"ETag", "Content-Range"})
        .answers(304, "It has not changed.", {}, {"ETag"})
        .fails({P::JobNotFound, P::ResultNotReady, P::ResultNotFound, P::JobDismissed,
                P::JobExpired, P::RangeNotSatisfiable, P::TooFewPoints, P::DegenerateShape,
                P::MalformedFile, P::TimedOut, P::OutOfMemory, P::IncompatibleDictionary,
                P::LimitExceeded, P::UnsupportedFormat, P::WorkerLost, P::InsufficientStorage});
    if (choice_of_format) operation.fails({P::InvalidParameter, P::NotAcceptable});
    return operation;
}

Json result_paths() {
    const std::string base = "/v1/jobs/{jobID}/results";
    Json paths;
    paths[base]["get"] =
        Operation("getResults", "Results", "What a job has left behind",
                  "A failed job answers with its own problem.")
            .parameter("jobID")
            .answers(200, "Where each result lies.", json_content(component("Results")))
            .fails({P::JobNotFound, P::ResultNotReady, P::JobDismissed, P::JobExpired,
                    P::TooFewPoints, P::DegenerateShape, P::MalformedFile, P::TimedOut,
                    P::OutOfMemory, P::IncompatibleDictionary, P::LimitExceeded,
                    P::UnsupportedFormat, P::WorkerLost, P::InsufficientStorage})
            .json();
    const Json ply = file_content({"application/ply"});
    const Json points = file_content({"application/ply", "application/vnd.draco"});
    const std::pair<std::string, Operation> files[] = {
        {"points", result("points", points, true)},
        {"dictionary", result("dictionary", json_content(component("Dictionary")), false)},
        {"report", result("report", json_content(component("Report")), false)},
        {"fields", result("fields", ply, false)}};
    for (const auto& [name, operation] : files) {
        paths[base + "/" + name]["get"] = operation.json();
        paths[base + "/" + name]["head"] = operation.head();
    }
    return paths;
}

Json retry() {
    return Operation("retryJob", "Jobs", "Try a job again",
                     "A new job with the inputs of one that has ended. Each links to the other.")
        .parameter("jobID")
        .parameter("idempotencyKey")
        .answers(201, "The new job is stored and will run.", json_content(component("StatusInfo")),
                 {"Location", "Link", "Idempotency-Replayed"})
        .fails({P::JobNotFound, P::JobDismissed, P::JobExpired, P::Conflict, P::ShapeNotFound,
                P::DictionaryNotFound, P::TooFewPoints, P::DegenerateShape, P::LengthRequired,
                P::PayloadTooLarge, P::IdempotencyConflict, P::IdempotencyMismatch,
                P::QuotaExceeded, P::QueueFull, P::Unavailable, P::InsufficientStorage})
        .json();
}

}  // namespace

Json execution_paths(const Limits& limits) {
    Json paths;
    for (const Task task : all_tasks()) {
        const std::string path = "/v1/processes/" + std::string(process_id(task)) + "/execution";
        paths[path]["post"] = execution(task, limits);
    }
    return paths;
}

Json job_paths() {
    Json paths = result_paths();
    paths["/v1/jobs"]["get"] =
        Operation("listJobs", "Jobs", "Jobs, newest first")
            .parameter("jobStatus")
            .parameter("jobProcess")
            .parameter("limit")
            .parameter("cursor")
            .answers(200, "A page of jobs.", json_content(component("JobList")))
            .fails({P::InvalidParameter})
            .json();
    paths["/v1/jobs/{jobID}"]["get"] =
        Operation("getJob", "Jobs", "State of a job",
                  "With `Prefer: wait=N` it answers as soon as the job has ended, after N seconds "
                  "at most.")
            .parameter("jobID")
            .parameter("preferWait")
            .answers(200, "Its state. Retry-After while it is not finished.",
                     json_content(component("StatusInfo"), status_example(Task::Denoise)),
                     {"Retry-After", "Preference-Applied"})
            .fails({P::JobNotFound, P::JobDismissed, P::JobExpired})
            .json();
    paths["/v1/jobs/{jobID}"]["delete"] =
        Operation("dismissJob", "Jobs", "Dismiss a job",
                  "A running job stops within a second; the results of a finished one go.")
            .parameter("jobID")
            .answers(200, "Dismissed.", json_content(component("StatusInfo")))
            .fails({P::JobNotFound, P::JobDismissed, P::JobExpired, P::Conflict})
            .json();
    paths["/v1/jobs/{jobID}/retry"]["post"] = retry();
    return paths;
}

}  // namespace lpf::openapi
