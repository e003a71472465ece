#pragma once

#include <semaphore>
#include <string>

#include "server/clock.h"
#include "server/config.h"
#include "server/data_dir.h"
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

    /// Seats for the decoding of files within requests: each may need much memory.
    static constexpr int kDecoders = 2;
    std::counting_semaphore<kDecoders> decoders{kDecoders};

    RequestsInFlight in_flight{};

    [[nodiscard]] const Limits& limits() const { return config.limits; }
    [[nodiscard]] UnixMillis result_retention() const {
        return static_cast<UnixMillis>(config.limits.result_retention_seconds) * 1000;
    }
};

/// Holds one of the decoders' seats.
class DecoderSeat {
public:
    explicit DecoderSeat(Services& services) : services_(services) { services_.decoders.acquire(); }
    ~DecoderSeat() { services_.decoders.release(); }
    DecoderSeat(const DecoderSeat&) = delete;
    DecoderSeat& operator=(const DecoderSeat&) = delete;

private:
    Services& services_;
};

}  // namespace lpf::server
