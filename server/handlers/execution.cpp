// POST /v1/processes/{id}/execution: from a body in one of three forms to a job that is not lost.
#include <nlohmann/json.hpp>

#include "api/http_text.h"
#include "api/json_text.h"
#include "api/parameters.h"
#include "api/results.h"
#include "server/answer.h"
#include "server/handlers/handlers.h"
#include "server/handlers/lookup.h"
#include "server/ids.h"
#include "server/ingest.h"

namespace lpf::server {
namespace {

/// What is to be done with which shape.
struct Order {
    ShapeInfo shape;
    JobInputs inputs;
};

std::multimap<std::string, std::string> query_inputs(const http::Request& request) {
    return {request.query.begin(), request.query.end()};
}

Order order_from_json(Services& services, const http::Request& request, Task task) {
    allow_query(request, {});
    const std::string text = receive_text(services, request);
    const ExecuteRequest wanted =
        execute_request_from_json(task, parse_json(text, services.limits()), services.limits());
    return {require_shape(services, wanted.shape), wanted.inputs};
}

Order order_from_form(Services& services, const http::Request& request, Task task) {
    Upload upload = receive_form(services, request);
    auto fields = query_inputs(request);
    fields.merge(upload.fields);
    JobInputs inputs = inputs_from_query(task, fields, services.limits());
    return {store_shape(services, std::move(upload)).info, std::move(inputs)};
}

/// Any other type, curl's default of a web form included: what the bytes are is seen from the
/// bytes.
Order order_from_file(Services& services, const http::Request& request, Task task) {
    JobInputs inputs = inputs_from_query(task, query_inputs(request), services.limits());
    return {store_shape(services, receive_file(services, request)).info, std::move(inputs)};
}

Order read_order(Services& services, const http::Request& request, Task task) {
    const std::string type = bare_media_type(request.header("content-type").value_or(""));
    if (type == "application/json") return order_from_json(services, request, task);
    if (type == "multipart/form-data") return order_from_form(services, request, task);
    return order_from_file(services, request, task);
}

StatusInfo make_job(Services& services, Task task, const Order& order) {
    require_workable(order.shape);
    if (order.inputs.dictionary) (void)require_dictionary(services, *order.inputs.dictionary);
    StatusInfo job;
    job.job_id = new_id();
    job.process = task;
    job.message = "Waiting for a worker.";
    job.created = job.updated = now_millis();
    job.parameters = order.inputs;
    job.shape = order.shape.id;
    job.warnings = order.shape.warnings;
    return job;
}

http::Response with_job_links(http::Response response, const std::string& id) {
    const std::string path = "/v1/jobs/" + id;
    response.set("Location", path);
    response.set("Link", "<" + path + ">; rel=\"monitor\"");
    return response;
}

http::Response created(Services& services, const std::string& id) {
    const auto job = services.queue.find(id);
    if (!job) throw Error(ErrorCode::StorageFailure, "A job that was stored is not there.");
    return json_response(to_json(job->info), 201);
}

/// The result itself: the points, or, where there are none, where each result lies.
http::Response result_itself(Services& services, const http::Request& request,
                             const std::string& id) {
    const StoredJob job = require_results(services, id);
    if (job.info.process == Task::Analyze)
        return json_response(results_to_json(job.info.job_id, job.results));
    return send_result(services, request, job, ResultKind::Points);
}

}  // namespace

http::Response execute_process(Services& services, http::Request& request) {
    const auto task = task_from_id(request.path_parameters.at(0));
    if (!task) {
        throw ProblemException(ProblemCode::ProcessNotFound,
                               "There is no process of this name; see /v1/processes.");
    }
    const StatusInfo job = make_job(services, *task, read_order(services, request, *task));
    services.queue.submit(job);
    services.log.info("job-accepted", {{"job", job.job_id}, {"request", request.id}});

    const auto wait = wanted_wait(services, request);
    if (!wait ||
        !services.queue.wait_for(job.job_id, std::chrono::seconds(*wait), request.abandoned)) {
        return with_job_links(created(services, job.job_id), job.job_id);
    }
    http::Response response = result_itself(services, request, job.job_id);
    response.set("Preference-Applied", "wait=" + std::to_string(*wait));
    return with_job_links(std::move(response), job.job_id);
}

}  // namespace lpf::server
