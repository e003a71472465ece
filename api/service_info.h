#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "api/limits.h"

namespace lpf {

/// GET /v1/: the landing page of OGC API.
[[nodiscard]] nlohmann::json landing_page();

/// GET /v1/conformance.
[[nodiscard]] nlohmann::json conformance();

/// What GET /v1/info tells of the running service besides its limits.
struct ServiceState {
    std::string version;
    std::uint64_t queued = 0;  ///< jobs accepted, not yet running
    std::uint64_t running = 0;
    std::uint64_t workers = 0;  ///< jobs that can run at once
    std::uint64_t threads_per_job = 0;
    std::uint64_t uptime_seconds = 0;
    bool authentication = false;  ///< API keys are required
};

/// GET /v1/info: {version, limits, formats, queue, retention, ...}.
[[nodiscard]] nlohmann::json service_info(const ServiceState& state, const Limits& limits);

}  // namespace lpf
