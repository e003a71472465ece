#include "api/limits.h"

#include <nlohmann/json.hpp>

namespace lpf {
namespace {

constexpr LimitField kLimits[] = {
    {"uploadBytes", "bytes", "Size of an uploaded file.", &Limits::upload_bytes},
    {"points", "points", "Points of a shape, and of a result.", &Limits::points},
    {"faces", "faces", "Faces of a mesh.", &Limits::faces},
    {"jsonBytes", "bytes", "Size of a JSON body.", &Limits::json_bytes},
    {"jsonDepth", "levels", "Nesting of a JSON body.", &Limits::json_depth},
    {"jsonStringBytes", "bytes", "Length of one string in a JSON body.",
     &Limits::json_string_bytes},
    {"headBytes", "bytes", "Size of a request's head.", &Limits::head_bytes},
    {"headFields", "fields", "Header fields of a request.", &Limits::head_fields},
    {"uriBytes", "bytes", "Length of a request's target.", &Limits::uri_bytes},
    {"headSeconds", "s", "Time for a request's head.", &Limits::head_seconds},
    {"bodyIdleSeconds", "s", "Silence within a request's body.", &Limits::body_idle_seconds},
    {"bodySeconds", "s", "Time for a whole request's body.", &Limits::body_seconds},
    {"bodyRateFloor", "bytes/s", "Least rate of a request's body, looked at after 10 s.",
     &Limits::body_rate_floor},
    {"writeStallSeconds", "s", "Time that a client may take nothing of its answer.",
     &Limits::write_stall_seconds},
    {"keepAliveSeconds", "s", "Time that a connection is kept for the next request.",
     &Limits::keep_alive_seconds},
    {"keepAliveRequests", "requests", "Requests on one connection.", &Limits::keep_alive_requests},
    {"connections", "connections", "Connections at a time.", &Limits::connections},
    {"connectionsPerClient", "connections",
     "Connections from one address; 0: no limit, for a reverse proxy that keeps its own.",
     &Limits::connections_per_client},
    {"uploadsAtOnce", "requests", "Requests with a body at a time.", &Limits::uploads_at_once},
    {"longRequestsAtOnce", "requests", "Requests at a time that wait, or convert a file.",
     &Limits::long_requests_at_once},
    {"eventStreams", "streams", "Event streams at a time.", &Limits::event_streams},
    {"eventStreamsPerClient", "streams",
     "Event streams of one API key, or of one address without keys; 0: no limit.",
     &Limits::event_streams_per_client},
    {"requestsPerSecond", "requests/s",
     "Requests of one API key, or of one address where there are no keys; 0 is no limit.",
     &Limits::requests_per_second},
    {"requestBurst", "requests", "Requests that may come at once after a pause.",
     &Limits::request_burst},
    {"uploadsPerSecond", "requests/s", "The same for POST requests.", &Limits::uploads_per_second},
    {"uploadBurst", "requests", "POST requests that may come at once after a pause.",
     &Limits::upload_burst},
    {"queuedJobs", "jobs", "Jobs waiting in the queue.", &Limits::queued_jobs},
    {"queuedJobsPerKey", "jobs", "Jobs of one API key waiting in the queue.",
     &Limits::queued_jobs_per_key},
    {"runningJobsPerKey", "jobs", "Jobs of one API key running at a time; 0 is one a core.",
     &Limits::running_jobs_per_key},
    {"smallJobPoints", "points", "Size up to which a job is small, and finds a worker kept free.",
     &Limits::small_job_points},
    {"jobSeconds", "s", "Time that a job may run.", &Limits::job_seconds},
    {"jobAttempts", "attempts", "Times that a job is started before it is given up.",
     &Limits::job_attempts},
    {"memoryBytes", "bytes",
     "Memory of all running jobs together, as estimated; 0 chooses from the memory of the machine "
     "or the container.",
     &Limits::memory_bytes},
    {"waitSeconds", "s", "Longest wait that a request may ask for.", &Limits::wait_seconds},
    {"pageItems", "items", "Items on one page of a list.", &Limits::page_items},
    {"patternPoints", "points", "Points of a pattern, M.", &Limits::pattern_points},
    {"atoms", "atoms", "Atoms of a dictionary, d.", &Limits::atoms},
    {"analysisIterations", "iterations", "Iterations of the joint analysis.",
     &Limits::analysis_iterations},
    {"denoiseIterations", "iterations", "Outer iterations of denoising.",
     &Limits::denoise_iterations},
    {"resultRetentionSeconds", "s", "Time that results are kept after a job ended.",
     &Limits::result_retention_seconds},
    {"statusRetentionSeconds", "s", "Time that a job's status is kept after it ended.",
     &Limits::status_retention_seconds},
    {"storedBytes", "bytes", "Files stored in all; 0 is no limit but the disk's.",
     &Limits::stored_bytes},
    {"diskFloorBytes", "bytes", "Free space under which nothing more is accepted.",
     &Limits::disk_floor_bytes},
    {"diskFloorPercent", "%", "Free share of the disk under which nothing more is accepted.",
     &Limits::disk_floor_percent},
};

}  // namespace

std::span<const LimitField> limit_table() { return kLimits; }

nlohmann::json to_json(const Limits& limits) {
    nlohmann::json json = nlohmann::json::object();
    for (const LimitField& field : kLimits) json[std::string(field.name)] = limits.*field.value;
    return json;
}

}  // namespace lpf
