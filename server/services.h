#pragma once

#include <string>

#include "server/clock.h"
#include "server/config.h"
#include "server/data_dir.h"
#include "server/decoding_room.h"
#include "server/idempotency.h"
#include "server/job_events.h"
#include "server/job_queue.h"
#include "server/log.h"
#include "server/preview_cache.h"
#include "server/storage.h"
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
