#include "api/job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/camel_case.h"
#include "api/choices.h"
#include "api/link.h"
#include "api/parameters.h"
#include "api/stored_json.h"

namespace lpf {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 5> kStatusNames{"accepted", "running", "successful",
                                                       "failed", "dismissed"};
// Registered link relations (RFC 5829) that say which way a retry lies.
constexpr std::string_view kRetryOf = "predecessor-version";
constexpr std::string_view kRetriedBy = "successor-version";
constexpr std::string_view kResultsRelation = "http://www.opengis.net/def/rel/ogc/1.0/results";

void put_times(json& target, const StatusInfo& info) {
    target["created"] = to_rfc3339(info.created);
    target["updated"] = to_rfc3339(info.updated);
    if (info.started) target["started"] = to_rfc3339(*info.started);
    if (info.finished) target["finished"] = to_rfc3339(*info.finished);
    if (info.expires) target["expires"] = to_rfc3339(*info.expires);
}

void put_progress(json& target, const StatusInfo& info) {
    target["progress"] = static_cast<int>(std::clamp(std::floor(info.progress), 0.0, 100.0));
    target["attempt"] = info.attempt;
    if (!info.phase.empty()) target["phase"] = info.phase;
    if (info.phase_progress) {
        target["phaseProgress"] = {{"done", info.phase_progress->done},
                                   {"total", info.phase_progress->total},
                                   {"unit", info.phase_progress->unit}};
    }
    if (info.eta_seconds) target["etaSeconds"] = *info.eta_seconds;
    if (info.queue_position) target["queuePosition"] = *info.queue_position;
    if (info.estimated_start) target["estimatedStart"] = to_rfc3339(*info.estimated_start);
}

json job_links(const StatusInfo& info) {
    const std::string self = "/v1/jobs/" + info.job_id;
    json links = json::array({to_json(Link{.href = self, .rel = "self"})});
    if (info.status == JobStatus::Dismissed) return links;  // all else is gone
    links.push_back(to_json(Link{.href = self + "/events",
                                 .rel = "alternate",
                                 .type = "text/event-stream",
                                 .title = "What happens, as it happens"}));
    links.push_back(to_json(Link{.href = self + "/preview",
                                 .rel = "preview",
                                 .type = "application/ply",
                                 .title = "A fair share of its points"}));
    if (info.status == JobStatus::Successful) {
        links.push_back(to_json(Link{.href = self + "/results",
                                     .rel = std::string(kResultsRelation),
                                     .title = "The results of this job"}));
    }
    if (info.retry_of) {
        links.push_back(to_json(Link{.href = "/v1/jobs/" + *info.retry_of,
                                     .rel = std::string(kRetryOf),
                                     .title = "The job that this one tries again"}));
    }
    for (const std::string& retry : info.retries) {
        links.push_back(to_json(Link{.href = "/v1/jobs/" + retry,
                                     .rel = std::string(kRetriedBy),
                                     .title = "A job that tries this one again"}));
    }
    return links;
}

std::optional<PhaseProgress> phase_progress_from_json(const json& stored) {
    const auto value = stored.find("phaseProgress");
    if (value == stored.end()) return std::nullopt;
    return PhaseProgress{.done = stored::need<std::uint64_t>(*value, "done"),
                         .total = stored::need<std::uint64_t>(*value, "total"),
                         .unit = stored::need<std::string>(*value, "unit")};
}

std::vector<ResolvedParameter> resolved_from_json(const json& stored) {
    std::vector<ResolvedParameter> parameters;
    const json entries = stored.value("resolvedParameters", json::object());
    for (const auto& [name, entry] : entries.items()) {
        ResolvedParameter parameter{
            .name = name,
            .value = {},
            .automatic = stored::need<std::string>(entry, "source") == "auto",
            .rule = stored::need<std::string>(entry, "rule")};
        if (entry.contains("value") && entry["value"].is_string()) {
            parameter.value = entry["value"].get<std::string>();
        } else {
            parameter.value = stored::need<double>(entry, "value");
        }
        parameters.push_back(std::move(parameter));
    }
    return parameters;
}

void read_times(StatusInfo& info, const json& stored) {
    info.created = stored::need_time(stored, "created");
    info.updated = stored::need_time(stored, "updated");
    info.started = stored::maybe_time(stored, "started");
    info.finished = stored::maybe_time(stored, "finished");
    info.expires = stored::maybe_time(stored, "expires");
}

void read_progress(StatusInfo& info, const json& stored) {
    info.progress = stored::need<double>(stored, "progress");
    info.attempt = stored::need<int>(stored, "attempt");
    info.phase = stored::maybe<std::string>(stored, "phase").value_or("");
    info.phase_progress = phase_progress_from_json(stored);
    info.eta_seconds = stored::maybe<double>(stored, "etaSeconds");
    info.queue_position = stored::maybe<std::uint64_t>(stored, "queuePosition");
    info.estimated_start = stored::maybe_time(stored, "estimatedStart");
}

}  // namespace

std::string_view status_name(JobStatus status) {
    return kStatusNames[static_cast<std::size_t>(status)];
}

std::optional<JobStatus> status_from_name(std::string_view name) {
    const auto* found = std::ranges::find(kStatusNames, name);
    if (found == kStatusNames.end()) return std::nullopt;
    return static_cast<JobStatus>(found - kStatusNames.begin());
}

bool may_become(JobStatus from, JobStatus to) {
    if (is_finished(from) || from == to) return false;
    return from == JobStatus::Running || to != JobStatus::Successful;
}

std::vector<ResolvedParameter> resolved_parameters(const std::vector<ResolvedValue>& values) {
    std::vector<ResolvedParameter> parameters;
    for (const ResolvedValue& value : values) {
        ResolvedParameter parameter{.name = camel_case(value.name),
                                    .value = value.value,
                                    .automatic = value.automatic,
                                    .rule = value.rule};
        if (parameter.name == "probing") {
            const auto kind = static_cast<ProbingKind>(static_cast<int>(value.value));
            parameter.value = std::string(choice_name(kind));
        }
        parameters.push_back(std::move(parameter));
    }
    return parameters;
}

json to_json(const std::vector<ResolvedParameter>& parameters) {
    json result = json::object();
    for (const ResolvedParameter& parameter : parameters) {
        json& entry = result[parameter.name];
        std::visit([&](const auto& value) { entry["value"] = value; }, parameter.value);
        entry["source"] = parameter.automatic ? "auto" : "request";
        entry["rule"] = parameter.rule;
    }
    return result;
}

json to_json(const StatusInfo& info) {
    json result = {{"jobID", info.job_id},
                   {"id", info.job_id},
                   {"processID", process_id(info.process)},
                   {"type", "process"},
                   {"status", status_name(info.status)},
                   {"message", info.message},
                   {"parameters", to_json(info.process, info.parameters)},
                   {"resolvedParameters", to_json(info.resolved_parameters)},
                   {"shape", info.shape},
                   {"warnings", stored::warnings_to_json(info.warnings)},
                   {"links", job_links(info)}};
    put_times(result, info);
    put_progress(result, info);
    if (info.exception) result["exception"] = to_json(*info.exception);
    if (info.retry_of) result["retryOf"] = *info.retry_of;
    return result;
}

StatusInfo status_from_json(const json& stored) {
    StatusInfo info;
    info.job_id = stored::need<std::string>(stored, "jobID");
    const auto task = task_from_id(stored::need<std::string>(stored, "processID"));
    const auto status = status_from_name(stored::need<std::string>(stored, "status"));
    if (!task) stored::damaged("processID");
    if (!status) stored::damaged("status");
    info.process = *task;
    info.status = *status;
    info.message = stored::need<std::string>(stored, "message");
    read_times(info, stored);
    read_progress(info, stored);
    info.parameters = stored_inputs_from_json(stored.value("parameters", json::object()));
    info.resolved_parameters = resolved_from_json(stored);
    info.shape = stored::need<std::string>(stored, "shape");
    info.warnings = stored::warnings_from_json(stored);
    info.retry_of = stored::maybe<std::string>(stored, "retryOf");
    if (stored.contains("exception")) info.exception = problem_from_json(stored["exception"]);
    return info;
}

json job_list_to_json(const std::vector<StatusInfo>& jobs, const std::string& query,
                      const std::string& next_cursor) {
    json entries = json::array();
    for (const StatusInfo& job : jobs) entries.push_back(to_json(job));
    const std::string path = "/v1/jobs";
    const std::string self = query.empty() ? path : path + "?" + query;
    json links = json::array({to_json(Link{.href = self, .rel = "self"})});
    if (!next_cursor.empty()) {
        const std::string next = self + (query.empty() ? "?" : "&") + "cursor=" + next_cursor;
        links.push_back(to_json(Link{.href = next, .rel = "next"}));
    }
    return {{"jobs", std::move(entries)}, {"links", std::move(links)}};
}

}  // namespace lpf
