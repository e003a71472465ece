#include "server/handlers/lookup.h"

#include "api/http_text.h"
#include "api/problem.h"
#include "api/uuid.h"

namespace lpf::server {
namespace {

/// Identifiers carry their time, so that a job that was swept away is told from one that never was.
bool would_have_expired(const Services& services, const std::string& id) {
    if (!is_uuid7(id)) return false;
    const auto age = now_millis() - uuid7_millis(id);
    return age > static_cast<UnixMillis>(services.limits().status_retention_seconds) * 1000;
}

}  // namespace

StoredJob require_job(Services& services, const std::string& id) {
    auto job = services.queue.find(id);
    if (!job && would_have_expired(services, id)) {
        throw ProblemException(ProblemCode::JobExpired,
                               "A job of this age is not kept any longer.");
    }
    if (!job) throw ProblemException(ProblemCode::JobNotFound, "There is no job of this ID.");
    if (job->info.status == JobStatus::Dismissed) {
        throw ProblemException(ProblemCode::JobDismissed,
                               "The job was dismissed at " +
                                   to_rfc3339(job->info.finished.value_or(job->info.updated)) +
                                   ".");
    }
    return *job;
}

StoredJob require_results(Services& services, const std::string& id) {
    StoredJob job = require_job(services, id);
    if (!is_finished(job.info.status)) {
        throw ProblemException({.problem = ProblemCode::ResultNotReady,
                                .detail = "The job is " +
                                          std::string(status_name(job.info.status)) +
                                          "; its results come when it is successful.",
                                .retry_after = 1});
    }
    if (job.info.exception) throw ProblemException(*job.info.exception);
    if (job.results_expired) {
        throw ProblemException(ProblemCode::JobExpired,
                               "The results of this job were kept until " +
                                   to_rfc3339(job.info.expires.value_or(0)) + ".");
    }
    return job;
}

ShapeInfo require_shape(Services& services, const std::string& id) {
    const auto shape = services.storage.jobs().find_shape(id);
    if (!shape) throw ProblemException(ProblemCode::ShapeNotFound, "There is no shape of this ID.");
    return *shape;
}

StoredDictionary require_dictionary(Services& services, const std::string& id) {
    const auto dictionary = services.storage.jobs().find_dictionary(id);
    if (!dictionary) {
        throw ProblemException(ProblemCode::DictionaryNotFound,
                               "There is no dictionary of this ID.");
    }
    return *dictionary;
}

std::optional<std::uint64_t> wanted_wait(const Services& services, const http::Request& request) {
    return prefer_wait(request.header("prefer").value_or(""), services.limits().wait_seconds);
}

}  // namespace lpf::server
