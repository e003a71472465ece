#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

namespace lpf {

/// Every limit that the service keeps, checked before anything is allocated. Each is a flag of the
/// server and is shown by GET /v1/info under the name that `limit_table` gives it.
struct Limits {
    std::uint64_t upload_bytes = 512ULL << 20;
    std::uint64_t points = 20'000'000;
    std::uint64_t faces = 40'000'000;

    std::uint64_t json_bytes = 1ULL << 20;
    std::uint64_t json_depth = 32;
    std::uint64_t json_string_bytes = 64ULL << 10;

    std::uint64_t head_bytes = 32ULL << 10;
    std::uint64_t head_fields = 100;
    std::uint64_t uri_bytes = 8ULL << 10;
    std::uint64_t head_seconds = 10;
    std::uint64_t body_idle_seconds = 15;
    std::uint64_t body_seconds = 3600;
    std::uint64_t body_rate_floor = 1024;
    std::uint64_t write_stall_seconds = 30;
    std::uint64_t keep_alive_seconds = 15;
    std::uint64_t keep_alive_requests = 100;
    std::uint64_t connections = 4096;
    std::uint64_t connections_per_client = 64;
    std::uint64_t uploads_at_once = 128;
    std::uint64_t long_requests_at_once = 64;
    std::uint64_t event_streams = 1024;
    std::uint64_t event_streams_per_client = 16;

    std::uint64_t requests_per_second = 100;  ///< 0: no limit
    std::uint64_t request_burst = 200;
    std::uint64_t uploads_per_second = 10;  ///< 0: no limit
    std::uint64_t upload_burst = 100;

    std::uint64_t queued_jobs = 1000;
    std::uint64_t queued_jobs_per_key = 100;
    std::uint64_t running_jobs_per_key = 0;  ///< 0: as many as there are cores
    std::uint64_t small_job_points = 100'000;
    std::uint64_t job_seconds = 3600;
    std::uint64_t job_attempts = 3;
    std::uint64_t memory_bytes = 0;  ///< of all jobs; 0: chosen from the memory there is
    std::uint64_t wait_seconds = 60;
    std::uint64_t page_items = 1000;

    std::uint64_t pattern_points = 12'849;
    std::uint64_t atoms = 256;
    std::uint64_t analysis_iterations = 1000;
    std::uint64_t denoise_iterations = 50;

    std::uint64_t result_retention_seconds = 7ULL * 24 * 3600;
    std::uint64_t status_retention_seconds = 30ULL * 24 * 3600;
    std::uint64_t stored_bytes = 0;  ///< 0: no limit but the disk's
    std::uint64_t disk_floor_bytes = 2ULL << 30;
    std::uint64_t disk_floor_percent = 5;
};

/// One limit as it is shown: name on the wire, unit, meaning, and where its value lies.
struct LimitField {
    std::string_view name;
    std::string_view unit;
    std::string_view description;
    std::uint64_t Limits::*value;
};

/// All limits, in the order of the struct. A test holds the two together.
[[nodiscard]] std::span<const LimitField> limit_table();

/// {"uploadBytes": 536870912, ...}: one member per row of `limit_table`.
[[nodiscard]] nlohmann::json to_json(const Limits& limits);

}  // namespace lpf
