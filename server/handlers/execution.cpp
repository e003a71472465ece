// POST /v1/processes/{id}/execution: from a body in one of three forms to a job that is not lost.
#include <nlohmann/json.hpp>

#include "api/http_text.h"
#include "api/json_text.h"
#include "api/parameters.h"
#include "api/results.h"
#include "server/handlers/job_request.h"
#include "server/requests/answer.h"
#include "server/requests/ingest.h"
#include "server/requests/lookup.h"
#include "server/store/sha256.h"

namespace lpf::server {
namespace {

/// A body as it came: a file with inputs, or a JSON text.
struct Sent {
    std::optional<Upload> upload = {};
    JobInputs inputs = {};
    std::string text = {};
    std::string digest = {};  ///< of what was sent
};

/// What is to be done with which shape.
struct Order {
    ShapeInfo shape;
    JobInputs inputs;
};

std::multimap<std::string, std::string> query_inputs(const http::Request& request) {
    return {request.query.begin(), request.query.end()};
}

Sent receive_json(Services& services, const http::Request& request) {
    allow_query(request, {});
    Sent sent{.text = receive_text(services, request)};
    sent.digest = sha256_of(sent.text);
    return sent;
}

/// The digest is that of the parts: a boundary is another each time.
Sent receive_filled_form(Services& services, const http::Request& request, Task task) {
    Sent sent{.upload = receive_form(services, request)};
    auto fields = query_inputs(request);
    Sha256 hash;
    for (const auto& [name, value] : sent.upload->fields)
        hash.update(std::to_string(name.size()) + ":" + name + std::to_string(value.size()) + ":" +
                    value);
    hash.update(sent.upload->file->digest());
    sent.digest = hash.finish();
    fields.merge(sent.upload->fields);
    sent.inputs = inputs_from_query(task, fields, services.limits());
    return sent;
}

/// Any other type, curl's default of a web form included: what the bytes are is seen from the
/// bytes.
Sent receive_bare_file(Services& services, const http::Request& request, Task task) {
    Sent sent{.inputs = inputs_from_query(task, query_inputs(request), services.limits())};
    sent.upload = receive_file(services, request);
    sent.digest = sent.upload->file->digest();
    return sent;
}

Sent receive(Services& services, const http::Request& request, Task task) {
    const std::string type = bare_media_type(request.header("content-type").value_or(""));
    if (type == "application/json") return receive_json(services, request);
    if (type == "multipart/form-data") return receive_filled_form(services, request, task);
    return receive_bare_file(services, request, task);
}

Order order_from(Services& services, Task task, Sent sent) {
    if (sent.upload)
        return {store_shape(services, *std::move(sent.upload)).info, std::move(sent.inputs)};
    ExecuteRequest wanted = execute_request_from_json(
        task, parse_json(sent.text, services.limits()), services.limits());
    (void)require_shape(services, wanted.shape);
    const auto shape = services.storage.jobs().keep_shape_until(
        wanted.shape, now_millis() + services.result_retention());
    if (!shape) throw ProblemException(ProblemCode::ShapeNotFound, "The shape was deleted.");
    return {*shape, std::move(wanted.inputs)};
}

/// @returns ID of the job
std::string make_job(Services& services, Task task, Sent sent, JobRequest& wish) {
    const Order order = order_from(services, task, std::move(sent));
    StatusInfo job = new_job(task, order.shape);
    job.parameters = order.inputs;
    if (order.inputs.dictionary) (void)require_dictionary(services, *order.inputs.dictionary);
    const std::string id = job.job_id;
    wish.submit(std::move(job), order.shape);
    return id;
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
    JobRequest wish(services, request);
    Sent sent = receive(services, request, *task);
    const auto before = wish.made_before(sent.digest);
    const std::string id = before ? *before : make_job(services, *task, std::move(sent), wish);

    const auto wait = wanted_wait(services, request);
    const bool ended =
        wait && services.queue.wait_for(id, std::chrono::seconds(*wait), request.abandoned);
    http::Response response = ended ? with_job_links(result_itself(services, request, id), id)
                                    : job_created(services, id);
    if (ended) response.set("Preference-Applied", "wait=" + std::to_string(*wait));
    if (before) response.set("Idempotency-Replayed", "true");
    return response;
}

}  // namespace lpf::server
