#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "api/job.h"

namespace lpf {

/// Data of the event `progress`: the members of the status that move while a job waits or runs.
[[nodiscard]] nlohmann::json progress_event_to_json(const StatusInfo& info);

/// Data of the event `log`.
[[nodiscard]] nlohmann::json log_event_to_json(std::string_view job_id, UnixMillis time,
                                               std::string_view code, std::string_view detail);

/// One event as text/event-stream has it. @pre data is one line
[[nodiscard]] std::string event_text(std::uint64_t id, std::string_view name,
                                     std::string_view data);

}  // namespace lpf
