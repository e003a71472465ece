#pragma once

#include <cmath>
#include <string>

#include "api/dictionary_document.h"
#include "api/job.h"
#include "api/report.h"
#include "api/shape_info.h"
#include "core/analysis.h"

/// Values with every member set, for round trips and for the checks against the schemas.
namespace lpf::test {

inline const std::string kJobId = "0198f3a2-7c1e-7d42-9b57-3f1d2a6c8e01";
inline const std::string kShapeId = "0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3";
inline const std::string kDictionaryId = "0198f3a2-7b90-7a11-ac3e-5d7f90b1c2d4";
inline const std::string kSha(64, 'a');
inline constexpr UnixMillis kTime = 1'772'366'400'123;  // 2026-03-01T12:00:00.123Z

inline StatusInfo full_status() {
    StatusInfo info;
    info.job_id = kJobId;
    info.process = Task::Resample;
    info.status = JobStatus::Failed;
    info.message = "failed";
    info.progress = 41.0;
    info.created = kTime;
    info.started = kTime + 1;
    info.finished = kTime + 2;
    info.updated = kTime + 3;
    info.expires = kTime + 4;
    info.phase = "vote";
    info.phase_progress = PhaseProgress{.done = 3, .total = 9, .unit = "points"};
    info.eta_seconds = 1.5;
    info.queue_position = 7;
    info.attempt = 2;
    info.parameters.factor = 4.0;
    info.parameters.atoms = 12;
    info.parameters.outliers = OutlierPolicy::Mark;
    info.resolved_parameters = {{"radius", 0.25, true, "rule"},
                                {"probing", std::string("noiseAware"), false, "given"}};
    info.shape = kShapeId;
    info.warnings = {{"radius-too-small", "few points"}};
    info.exception = Problem{.problem = ProblemCode::TimedOut, .detail = "too slow"};
    return info;
}

inline ShapeInfo full_shape() {
    ShapeInfo info;
    info.id = kShapeId;
    info.format = "ply";
    info.bytes = 12345;
    info.sha256 = kSha;
    info.points = 1000;
    info.faces = 20;
    info.attributes = {{"red", "uint8", false}, {"echo", "float32", true}};
    info.bounds = Bounds{{-1.0, -2.0, -3.0}, {1.0, 2.0, 3.5}};
    info.mean_spacing = 0.01;
    info.created = kTime;
    info.expires = kTime + 1000;
    info.warnings = {{"non-finite-points-dropped", "3 points"}};
    return info;
}

/// Atom k of a grid: value (k + 1) / 100 in x of node 0, a ramp in z.
inline Dictionary small_dictionary(int atoms) {
    Dictionary dictionary(Pattern::grid(8), atoms);
    const auto stride = static_cast<std::size_t>(dictionary.pattern().padded_size());
    for (int k = 0; k < atoms; ++k) {
        dictionary.atom(k)[0] = 0.01F * static_cast<float>(k + 1);
        for (std::size_t i = 0; i < static_cast<std::size_t>(dictionary.pattern().size()); ++i) {
            dictionary.atom(k)[2 * stride + i] = static_cast<float>(i) / 1000.0F;
        }
    }
    return dictionary;
}

/// Two LPFs over three atoms: the first uses atoms 0 and 2, the second none.
inline AnalysisResult small_analysis() {
    AnalysisResult result{small_dictionary(3), {}, {}, {}, {}, {}, {}};
    Frame frame;
    frame.centre = {500000.25, 2.0, 3.0};
    frame.radius = 0.5;
    frame.origin = {0.5F, 0.0F, 0.0F};
    result.frames = {frame, frame};
    result.codes = SparseCodes(2, 3);
    result.codes[0][0] = 0.5F;
    result.codes[0][2] = -2.0F;
    result.residuals = {0.125F, 0.25F};
    result.dimensions = {2, 0};
    result.usage = {0.5F, 0.0F, 0.5F};
    result.energy = {{3.0, 2.0, 1.5}, {1.25, 1.0, 0.75}};
    result.radius = 0.5;
    result.lambda = 0.2;
    return result;
}

inline Report full_report(Task task) {
    Report report;
    report.version = "1.2.3";
    report.job_id = kJobId;
    report.process = task;
    report.input_points = 10;
    report.input_faces = 4;
    report.output_points = 10;
    report.input_bounds = Bounds{};
    report.output_bounds = Bounds{};
    report.resolved_parameters = full_status().resolved_parameters;
    report.fields = 2;
    report.energy = small_analysis().energy;
    report.rms_moves = {0.1, 0.01};
    report.displacement = DisplacementStatistics{};
    report.phase_seconds = {{"decode", 0.5}, {"learn", 1.5}};
    report.total_seconds = 2.0;
    report.threads = 2;
    report.peak_memory_bytes = 1 << 20;
    report.warnings = {{"a-code", "text"}};
    return report;
}

}  // namespace lpf::test
