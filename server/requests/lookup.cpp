#include "server/requests/lookup.h"

#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "api/http_text.h"
#include "api/parameters.h"
#include "api/problem.h"
#include "api/uuid.h"
#include "server/store/mapped_file.h"

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

Dictionary load_dictionary(Services& services, const std::string& id) {
    const StoredDictionary stored = require_dictionary(services, id);
    const MappedFile file(services.storage.blobs().local_file(stored.sha256));
    const auto json = nlohmann::json::parse(file.text(), nullptr, false);
    return dictionary_from_json(json, services.limits()).dictionary;
}

Task require_process(const std::string& id) {
    const auto task = task_from_id(id);
    if (task) return *task;
    throw ProblemException(ProblemCode::ProcessNotFound,
                           "There is no process of this name; see /v1/processes.");
}

std::optional<std::uint64_t> wanted_wait(const Services& services, const http::Request& request) {
    return prefer_wait(request.header("prefer").value_or(""), services.limits().wait_seconds);
}

}  // namespace lpf::server
