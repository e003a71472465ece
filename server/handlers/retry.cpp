// POST /v1/jobs/{id}/retry: a new job with the inputs of one that has ended.
#include "api/problem.h"
#include "server/handlers/job_request.h"
#include "server/requests/answer.h"
#include "server/requests/ingest.h"
#include "server/requests/lookup.h"
#include "server/store/sha256.h"

namespace lpf::server {
namespace {

StatusInfo require_ended(Services& services, const std::string& id) {
    const StatusInfo job = require_job(services, id).info;
    if (!is_finished(job.status)) {
        throw ProblemException(ProblemCode::Conflict,
                               "The job is " + std::string(status_name(job.status)) +
                                   "; only one that has ended can be tried again.");
    }
    return job;
}

ShapeInfo require_shape_of(Services& services, const StatusInfo& job) {
    const auto shape = services.storage.jobs().keep_shape_until(
        job.shape, now_millis() + services.result_retention());
    if (!shape) {
        throw ProblemException(ProblemCode::ShapeNotFound,
                               "The shape of this job is not kept any longer. Upload it again, and "
                               "start a job on it.");
    }
    return *shape;
}

}  // namespace

http::Response retry_job(Services& services, http::Request& request) {
    allow_query(request, {});
    JobRequest wish(services, request);
    const std::string body = receive_text(services, request);
    if (!body.empty()) {
        throw ProblemException(ProblemCode::MalformedRequest,
                               "A retry takes no body: its inputs are those of the job.");
    }
    if (const auto id = wish.made_before(sha256_of(body))) {
        return job_created(services, *id).set("Idempotency-Replayed", "true");
    }
    const StatusInfo before = require_ended(services, request.path_parameters.at(0));
    if (before.parameters.dictionary)
        (void)require_dictionary(services, *before.parameters.dictionary);
    const ShapeInfo shape = require_shape_of(services, before);
    StatusInfo job = new_job(before.process, shape);
    job.parameters = before.parameters;
    job.retry_of = before.job_id;
    const std::string id = job.job_id;
    wish.submit(std::move(job), shape);
    return job_created(services, id);
}

}  // namespace lpf::server
