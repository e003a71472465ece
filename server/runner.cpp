#include "server/runner.h"

#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "api/report.h"
#include "core/denoising/tiled_denoise.h"
#include "server/shapes/streaming.h"
#include "server/work/computation.h"
#include "server/work/phases.h"
#include "server/work/preparation.h"
#include "server/work/result_writer.h"

namespace lpf::server {
namespace {

void pass_on_warnings(RunningJob& job, const std::vector<Warning>& warnings) {
    for (const Warning& warning : warnings) job.warn(warning.code, warning.detail);
}

/// The report, and all that the job leaves behind.
JobOutcome finish(Report report, ResultWriter& writer, const PhaseTimes& times,
                  const RunningJob& job) {
    report.phase_seconds = times.seconds();
    report.total_seconds = job.seconds();
    writer.add_report(report);
    JobOutcome outcome = writer.take_outcome();
    outcome.phase_seconds = times.seconds();
    return outcome;
}

}  // namespace

Runner::Runner(Storage& storage, RunnerOptions options)
    : storage_(storage), options_(std::move(options)) {}

JobOutcome Runner::run(RunningJob& job) const {
    const StatusInfo asked = job.info();
    const ShapeInfo shape = find_shape(asked.shape);
    const MappedFile file(storage_.blobs().local_file(shape.sha256));
    const auto points = streamed_points(asked.process, asked.parameters, file, options_.limits,
                                        options_.most_in_memory);
    return points ? run(job, shape, *points) : run(job, file);
}

JobOutcome Runner::run(RunningJob& job, const MappedFile& file) const {
    const StatusInfo asked = job.info();
    const JobInputs& inputs = asked.parameters;
    PhaseTimes times;

    job.enter_phase("decode", 0);
    Document document =
        decode(file.bytes(), decode_limits(options_.limits), execution(job, 0, kDecoded));
    file.let_go(file.bytes().size());
    pass_on_warnings(job, document.warnings);
    Report report = start_report(asked, document, options_.version, options_.threads);
    times.end_of("decode");

    job.enter_phase("prepare", kDecoded);
    document = apply_policies(std::move(document), inputs, execution(job, kDecoded, kPrepared), job,
                              report);
    times.end_of("prepare");

    job.enter_phase("measure", kPrepared);
    report.measurements =
        measure(document.shape.cloud.points, execution(job, kPrepared, kMeasured));
    const ResolvedParameters parameters = resolve(job, document.shape, report.measurements);
    times.end_of("measure");

    Computation result =
        compute(asked.process, document.shape, parameters, execution(job, kMeasured, kComputed));
    times.end_of("compute");

    job.enter_phase("encode", kComputed);
    const Execution writing = execution(job, kComputed, kWritten);
    ResultWriter writer(storage_, job, options_.version, writing);
    if (result.points) {
        document = carry_attributes(std::move(document), result, inputs, writing, job, report);
        writer.add_points(document, inputs, report.measurements);
    }
    writer.add_dictionary(result.analysis);
    writer.add_fields(result.analysis);
    times.end_of("encode");

    finish_report(report, result.analysis, result.rms_moves, job.info());
    return finish(std::move(report), writer, times, job);
}

JobOutcome Runner::run(RunningJob& job, const ShapeInfo& shape, const PlyPoints& points) const {
    const StatusInfo asked = job.info();
    PhaseTimes times;

    job.enter_phase("measure", 0);
    pass_on_warnings(job, shape.warnings);
    Report report = start_report(asked, shape, points.size(), options_.version, options_.threads);
    report.measurements = measure(points, execution(job, 0, kMeasured));
    const ResolvedParameters parameters = resolve(job, {}, report.measurements);
    times.end_of("measure");

    TiledDenoising result =
        denoise_tiles(points, parameters.denoise, execution(job, kMeasured, kComputed),
                      {.count_duplicates = true});
    report.duplicates = result.duplicates;
    tell_duplicates(report.duplicates, DuplicatePolicy::Keep, job);
    times.end_of("compute");

    job.enter_phase("encode", kComputed);
    ResultWriter writer(storage_, job, options_.version, execution(job, kComputed, kWritten));
    const WrittenPoints written =
        writer.add_moved(points, result.moves, report.measurements.points);
    report.output_points = written.points;
    report.output_bounds = Bounds{written.minimum, written.maximum};
    report.displacement =
        displacement_statistics(lengths_of(result.moves, report.measurements.points));
    writer.add_dictionary(result.analysis);
    writer.add_fields(result.analysis);
    times.end_of("encode");

    finish_report(report, result.analysis, result.rms_moves, job.info());
    return finish(std::move(report), writer, times, job);
}

ShapeInfo Runner::find_shape(const std::string& shape_id) const {
    const auto shape = storage_.jobs().find_shape(shape_id);
    if (!shape)
        throw ProblemException(ProblemCode::ShapeNotFound, "The shape of this job was deleted.");
    return *shape;
}

Dictionary Runner::load_dictionary(const std::string& dictionary_id) const {
    const auto stored = storage_.jobs().find_dictionary(dictionary_id);
    if (!stored) {
        throw ProblemException(ProblemCode::DictionaryNotFound,
                               "The dictionary of this job is not here any more.");
    }
    const MappedFile file(storage_.blobs().local_file(stored->sha256));
    const auto json = nlohmann::json::parse(file.text(), nullptr, false);
    return dictionary_from_json(json, options_.limits).dictionary;
}

ResolvedParameters Runner::resolve(RunningJob& job, const Shape& shape,
                                   const Measurements& measurements) const {
    const StatusInfo asked = job.info();
    ParameterRequest request = to_request(asked.parameters, measurements);
    if (asked.parameters.dictionary) {
        request.dictionary = load_dictionary(*asked.parameters.dictionary);
        request.keep_dictionary = asked.parameters.dictionary_mode == DictionaryMode::Fixed;
    }
    ResolvedParameters parameters = resolve_parameters(asked.process, shape, measurements, request);
    job.update([&](StatusInfo& info) {
        info.resolved_parameters = resolved_parameters(parameters.values);
    });
    for (const std::string& warning : parameters.warnings) job.warn("parameters", warning);
    return parameters;
}

Execution Runner::execution(RunningJob& job, double low, double high) const {
    return {.threads = options_.threads,
            .stop = job.stop_token(),
            .progress = job.progress_sink(low, high)};
}

}  // namespace lpf::server
