#pragma once

#include <optional>
#include <string>

#include "server/handlers/handlers.h"

namespace lpf::server {

/// A request that makes a job: at most one, however often it is sent with the same Idempotency-Key.
class JobRequest {
public:
    /// @throws ProblemException{MalformedRequest, IdempotencyConflict}
    JobRequest(Services& services, const http::Request& request);

    /// ID of the job that the same request has made before, if there is one.
    /// @throws ProblemException{IdempotencyMismatch} if another request had this key
    [[nodiscard]] std::optional<std::string> made_before(const std::string& body_digest);

    /// Makes the job durable. @throws as JobQueue::submit and memory_for_job
    void submit(StatusInfo job, const ShapeInfo& shape);

private:
    Services& services_;
    const http::Request& request_;
    std::optional<std::string> key_;
    std::optional<RequestMark> mark_;
    std::optional<RequestsInFlight::Seat> seat_;
};

/// A job that waits: everything but its inputs. @throws ProblemException{TooFewPoints, ...}
[[nodiscard]] StatusInfo new_job(Task task, const ShapeInfo& shape);

/// 201 with the state of the job, whether it is new or was made by the same request before.
[[nodiscard]] http::Response job_created(Services& services, const std::string& id);

/// Location and Link to the job.
[[nodiscard]] http::Response with_job_links(http::Response response, const std::string& id);

}  // namespace lpf::server
