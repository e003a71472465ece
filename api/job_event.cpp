#include "api/job_event.h"

#include <nlohmann/json.hpp>

namespace lpf {

using nlohmann::json;

json progress_event_to_json(const StatusInfo& info) {
    const json whole = to_json(info);
    json moving = json::object();
    for (const char* name : {"jobID", "status", "message", "progress", "updated", "phase",
                             "phaseProgress", "etaSeconds", "queuePosition"}) {
        if (const auto member = whole.find(name); member != whole.end()) moving[name] = *member;
    }
    return moving;
}

json log_event_to_json(std::string_view job_id, UnixMillis time, std::string_view code,
                       std::string_view detail) {
    return {{"jobID", job_id}, {"time", to_rfc3339(time)}, {"code", code}, {"detail", detail}};
}

std::string event_text(std::uint64_t id, std::string_view name, std::string_view data) {
    std::string text = "id: " + std::to_string(id) + "\nevent: ";
    text.append(name).append("\ndata: ").append(data).append("\n\n");
    return text;
}

}  // namespace lpf
