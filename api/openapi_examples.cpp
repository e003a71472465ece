#include "api/openapi_examples.h"

#include <nlohmann/json.hpp>

#include "api/job.h"

namespace lpf::openapi {
namespace {

constexpr const char* kJob = "0198f3a2-7c1e-7d42-9b57-3f1d2a6c8e01";
constexpr const char* kShape = "0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3";
constexpr UnixMillis kCreated = 1'772'366'400'000;  // 2026-03-01T12:00:00Z

}  // namespace

nlohmann::json execution_example() {
    return {{"inputs", {{"shape", kShape}, {"radius", 6.0}, {"radiusUnit", "spacing"}}}};
}

nlohmann::json status_example(Task task) {
    StatusInfo info;
    info.job_id = kJob;
    info.process = task;
    info.status = JobStatus::Running;
    info.message = "learning the dictionary";
    info.progress = 42.0;
    info.created = kCreated;
    info.started = kCreated + 15;
    info.updated = kCreated + 2'350;
    info.phase = "learn";
    info.phase_progress = PhaseProgress{.done = 5120, .total = 8192, .unit = "fields"};
    info.eta_seconds = 3.2;
    info.attempt = 1;
    info.parameters.radius = 6.0;
    info.parameters.radius_unit = RadiusUnit::Spacing;
    info.resolved_parameters = {{.name = "atoms",
                                 .value = 16.0,
                                 .automatic = true,
                                 .rule = "enough for most shapes, few enough to consolidate"}};
    info.shape = kShape;
    return to_json(info);
}

}  // namespace lpf::openapi
