#include "server/handlers/job_request.h"

#include <nlohmann/json.hpp>

#include "server/ids.h"
#include "server/requests/admission.h"
#include "server/requests/answer.h"
#include "server/requests/ingest.h"

namespace lpf::server {
namespace {

std::optional<std::string> key_of(const http::Request& request) {
    const auto header = request.header("idempotency-key");
    return header ? std::optional(idempotency_key(*header)) : std::nullopt;
}

}  // namespace

JobRequest::JobRequest(Services& services, const http::Request& request)
    : services_(services), request_(request), key_(key_of(request)) {
    if (key_) seat_.emplace(services.in_flight.enter({request.key, *key_}));
}

std::optional<std::string> JobRequest::made_before(const std::string& body_digest) {
    if (!key_) return std::nullopt;
    mark_ = RequestMark{*key_, fingerprint(request_, body_digest)};
    const auto before = services_.storage.jobs().find_request(request_.key, *key_);
    if (!before) return std::nullopt;
    if (before->fingerprint != mark_->fingerprint) {
        throw ProblemException(ProblemCode::IdempotencyMismatch,
                               "Another request was sent with this Idempotency-Key; it made job " +
                                   before->job_id + ". A new request needs a key of its own.");
    }
    services_.log.info("job-request-replayed", {{"job", before->job_id}, {"request", request_.id}});
    return before->job_id;
}

void JobRequest::submit(StatusInfo job, const ShapeInfo& shape) {
    const std::string id = job.job_id;
    const std::uint64_t memory = memory_for_job(services_, request_, job, shape);
    services_.queue.submit({.info = std::move(job),
                            .owner = request_.key,
                            .points = shape.points,
                            .memory = memory,
                            .mark = mark_});
    seat_.reset();  // from now on the books know the answer
    services_.log.info("job-accepted", {{"job", id}, {"request", request_.id}});
}

StatusInfo new_job(Task task, const ShapeInfo& shape) {
    require_workable(shape);
    StatusInfo job;
    job.job_id = new_id();
    job.process = task;
    job.message = "Waiting for a worker.";
    job.created = job.updated = now_millis();
    job.shape = shape.id;
    job.warnings = shape.warnings;
    return job;
}

http::Response job_created(Services& services, const std::string& id) {
    const auto job = services.queue.find(id);
    if (!job) throw Error(ErrorCode::StorageFailure, "A job that was stored is not there.");
    return with_job_links(json_response(to_json(job->info), 201), id);
}

http::Response with_job_links(http::Response response, const std::string& id) {
    const std::string path = "/v1/jobs/" + id;
    response.set("Location", path);
    response.set("Link", "<" + path + ">; rel=\"monitor\"");
    return response;
}

}  // namespace lpf::server
