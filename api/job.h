#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/codec/document.h"
#include "api/job_inputs.h"
#include "api/problem.h"
#include "api/time_text.h"

namespace lpf {

/// The statuses of OGC API - Processes.
enum class JobStatus { Accepted, Running, Successful, Failed, Dismissed };

[[nodiscard]] std::string_view status_name(JobStatus status);  ///< "accepted", ...
[[nodiscard]] std::optional<JobStatus> status_from_name(std::string_view name);

/// True once nothing can change any more.
[[nodiscard]] constexpr bool is_finished(JobStatus status) {
    return status != JobStatus::Accepted && status != JobStatus::Running;
}

/// True if a job may go from one status to the other: accepted -> running, dismissed, failed;
/// running -> any other (back to accepted when its worker was lost).
[[nodiscard]] bool may_become(JobStatus from, JobStatus to);

struct PhaseProgress {
    std::uint64_t done = 0;
    std::uint64_t total = 0;
    std::string unit;

    bool operator==(const PhaseProgress&) const = default;
};

/// A parameter as it was used, and where it came from.
struct ResolvedParameter {
    std::string name;  ///< camelCase, as in the inputs
    std::variant<double, std::string> value;
    bool automatic = false;  ///< "source": "auto", else "request"
    std::string rule;        ///< one sentence: how it was found

    bool operator==(const ResolvedParameter&) const = default;
};

/// For the wire: names of core (snake_case) become those of the inputs (camelCase).
[[nodiscard]] std::vector<ResolvedParameter> resolved_parameters(
    const std::vector<ResolvedValue>& values);

/// {"radius": {"value": 0.2, "source": "auto", "rule": "..."}, ...}
[[nodiscard]] nlohmann::json to_json(const std::vector<ResolvedParameter>& parameters);

/// State of a job: stored by the server, answered by GET /v1/jobs/{id}.
struct StatusInfo {
    std::string job_id;  ///< UUIDv7
    Task process = Task::Denoise;
    JobStatus status = JobStatus::Accepted;
    std::string message;    ///< one line for a human
    double progress = 0.0;  ///< 0 to 100; shown as an integer
    UnixMillis created = 0;
    std::optional<UnixMillis> started;
    std::optional<UnixMillis> finished;
    UnixMillis updated = 0;
    std::optional<UnixMillis> expires;  ///< when the results go
    std::string phase;                  ///< empty until it runs
    std::optional<PhaseProgress> phase_progress;
    std::optional<double> eta_seconds;
    std::optional<std::uint64_t> queue_position;  ///< 1 = next
    std::optional<UnixMillis> estimated_start;    ///< of a job that waits
    int attempt = 0;                              ///< 0 until it was started once
    JobInputs parameters;
    std::vector<ResolvedParameter> resolved_parameters;
    std::string shape;  ///< ID of the input shape
    std::vector<Warning> warnings;
    std::optional<Problem> exception;       ///< of a failed job
    std::optional<std::string> retry_of;    ///< ID of the job whose inputs it has
    std::vector<std::string> retries = {};  ///< IDs of the jobs that have its inputs; not stored
};

/// The whole document. Members without a value are left out; `links` follow from the state.
[[nodiscard]] nlohmann::json to_json(const StatusInfo& info);

/// The inverse of to_json, for what was stored.
/// @throws lpf::Error{StorageFailure} if a needed member is missing or of the wrong type
[[nodiscard]] StatusInfo status_from_json(const nlohmann::json& json);

/// {jobs, links}. @param next_cursor of the next page, empty on the last
/// @param query of this request without the cursor ("status=running&limit=10"), for the links
[[nodiscard]] nlohmann::json job_list_to_json(const std::vector<StatusInfo>& jobs,
                                              const std::string& query,
                                              const std::string& next_cursor);

}  // namespace lpf
