#pragma once

#include <string>

#include "server/clock.h"
#include "server/config.h"
#include "server/job_queue.h"
#include "server/jobs/job_events.h"
#include "server/log.h"
#include "server/requests/idempotency.h"
#include "server/requests/preview_cache.h"
#include "server/shapes/decoding_room.h"
#include "server/store/data_dir.h"
#include "server/store/storage.h"
#include "server/telemetry.h"

namespace lpf::server {

/// What the handlers work with. Everything outlives the listeners.
struct Services {
    const Config& config;
    const DataDir& data;
    Storage& storage;
    JobQueue& queue;
    JobEvents& events;
    PreviewCache& previews;
    Log& log;
    Telemetry& telemetry;

    DecodingRoom decoding{config.decoding_bytes};

    RequestsInFlight in_flight{};

    [[nodiscard]] const Limits& limits() const { return config.limits; }
    [[nodiscard]] UnixMillis result_retention() const {
        return static_cast<UnixMillis>(config.limits.result_retention_seconds) * 1000;
    }
};

}  // namespace lpf::server
