#include "api/openapi/examples.h"

#include <nlohmann/json.hpp>

#include "api/job.h"
#include "api/job_event.h"
#include "api/validation.h"

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

nlohmann::json validation_example(Task task) {
    Validation v;
    v.process = task;
    v.shape = kShape;
    v.format = "ply";
    v.points = 100'000;
    v.resolved_parameters = {{.name = "radius",
                              .value = 0.0304,
                              .automatic = true,
                              .rule = "root of the sum of squares of 0.6 times the radius that "
                                      "holds about 150 points and 3 times the noise"}};
    v.measurements = {.points = 100'000,
                      .diagonal = 2.8,
                      .mean_spacing = 0.0048,
                      .noise = 0.003,
                      .density_radius = 0.044};
    v.neighbours = {0.0304, {12, 41, 55, 60, 66, 70}};
    if (task == Task::Analyze) {
        v.attributes = {{"red", "vertex", Fate::Unused, "An analysis makes no points."}};
    } else {
        v.attributes = {{"red", "vertex", task == Task::Denoise ? Fate::Kept : Fate::Carried,
                         "Each point keeps its own value."}};
    }
    v.work.task = task;
    v.work.fields = 12'922;
    v.work.output_points = 100'000;
    v.estimate = {.seconds = 1.9, .memory_bytes = 63e6};
    v.threads = 2;
    return to_json(v);
}

std::string events_example() {
    const std::string job = kJob;
    return "retry: 2000\n\n" +
           event_text(1'772'366'400'001'001, "progress",
                      R"({"jobID":")" + job +
                          R"(","message":"","progress":42,"status":"running","updated":)"
                          R"("2026-03-01T12:00:02.350Z"})");
}

}  // namespace lpf::openapi
