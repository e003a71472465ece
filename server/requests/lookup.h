#pragma once

#include <string>

#include "core/auto_parameters.h"
#include "server/http/message.h"
#include "server/services.h"

/// What several handlers look up, with the right problem when it is not there.
namespace lpf::server {

/// The job of /v1/jobs/{id}.
/// @throws ProblemException{JobNotFound, JobDismissed, JobExpired}
[[nodiscard]] StoredJob require_job(Services& services, const std::string& id);

/// A job that has results to hand out.
/// @throws ProblemException as require_job, {ResultNotReady}, or the failed job's own problem
[[nodiscard]] StoredJob require_results(Services& services, const std::string& id);

/// @throws ProblemException{ShapeNotFound}
[[nodiscard]] ShapeInfo require_shape(Services& services, const std::string& id);

/// @throws ProblemException{DictionaryNotFound}
[[nodiscard]] StoredDictionary require_dictionary(Services& services, const std::string& id);

/// The dictionary itself. @throws as require_dictionary
[[nodiscard]] Dictionary load_dictionary(Services& services, const std::string& id);

/// The process of /v1/processes/{id}. @throws ProblemException{ProcessNotFound}
[[nodiscard]] Task require_process(const std::string& id);

/// Seconds of `Prefer: wait`, or nothing.
[[nodiscard]] std::optional<std::uint64_t> wanted_wait(const Services& services,
                                                       const http::Request& request);

/// Hands out one of the results of a job.
[[nodiscard]] http::Response send_result(Services& services, const http::Request& request,
                                         const StoredJob& job, ResultKind kind);

}  // namespace lpf::server
