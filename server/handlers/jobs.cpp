#include <nlohmann/json.hpp>

#include "api/parameters.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/lookup.h"

namespace lpf::server {
namespace {

constexpr std::uint64_t kDefaultPage = 20;

JobFilter filter_of(const Services& services, const http::Request& request) {
    JobFilter filter;
    filter.limit = query_number(request, "limit", services.limits().page_items, kDefaultPage);
    filter.cursor = request.query_value("cursor").value_or("");
    if (const auto status = request.query_value("status")) {
        filter.status = status_from_name(*status);
        if (!filter.status)
            throw query_problem("status",
                                "It is one of accepted running successful failed dismissed.");
    }
    if (const auto process = request.query_value("processID")) {
        filter.process = task_from_id(*process);
        if (!filter.process) throw query_problem("processID", "See /v1/processes for the names.");
    }
    return filter;
}

/// The query of the links to other pages: what was checked above, and so needs no escaping.
std::string query_of(const http::Request& request) {
    std::string text;
    for (const char* name : {"status", "processID", "limit"}) {
        if (const auto value = request.query_value(name))
            text += (text.empty() ? "" : "&") + std::string(name) + "=" + *value;
    }
    return text;
}

http::Response answer_job(const StatusInfo& info) {
    http::Response response = json_response(to_json(info));
    if (!is_finished(info.status)) response.set("Retry-After", "1");
    return response;
}

}  // namespace

http::Response list_jobs(Services& services, http::Request& request) {
    allow_query(request, {"status", "processID", "limit", "cursor"});
    const JobPage page = services.queue.list(filter_of(services, request));
    return json_response(job_list_to_json(page.jobs, query_of(request), page.next_cursor));
}

http::Response get_job(Services& services, http::Request& request) {
    allow_query(request, {});
    const std::string& id = request.path_parameters.at(0);
    StoredJob job = require_job(services, id);
    const auto wait = wanted_wait(services, request);
    if (!wait || is_finished(job.info.status)) return answer_job(job.info);
    const bool ended = services.queue.wait_for(id, std::chrono::seconds(*wait), request.abandoned);
    http::Response response = answer_job(require_job(services, id).info);
    if (ended) response.set("Preference-Applied", "wait=" + std::to_string(*wait));
    return response;
}

http::Response dismiss_job(Services& services, http::Request& request) {
    allow_query(request, {});
    const StoredJob job = require_job(services, request.path_parameters.at(0));
    const auto info = services.queue.dismiss(job.info.job_id);
    if (!info) throw ProblemException(ProblemCode::JobDismissed, "The job was dismissed before.");
    std::vector<std::string> digests;
    for (const ResultFile& file : job.results) digests.push_back(file.sha256);
    services.storage.forget(digests);
    services.log.info("job-dismissal", {{"job", info->job_id}, {"request", request.id}});
    return json_response(to_json(*info));
}

}  // namespace lpf::server
