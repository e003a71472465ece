#include "api/results.h"

#include <nlohmann/json.hpp>

namespace lpf {

std::string_view result_name(ResultKind kind) {
    switch (kind) {
        case ResultKind::Points: return "points";
        case ResultKind::Dictionary: return "dictionary";
        case ResultKind::Report: return "report";
        case ResultKind::Fields: return "fields";
    }
    return "";
}

nlohmann::json results_to_json(std::string_view job_id, const std::vector<ResultFile>& files) {
    nlohmann::json json = nlohmann::json::object();
    for (const ResultFile& file : files) {
        const std::string name(result_name(file.kind));
        json[name] = {{"href", "/v1/jobs/" + std::string(job_id) + "/results/" + name},
                      {"type", file.type},
                      {"bytes", file.bytes},
                      {"sha256", file.sha256}};
    }
    return json;
}

}  // namespace lpf
