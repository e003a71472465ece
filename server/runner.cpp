#include "server/runner.h"

#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "api/report.h"
#include "server/computation.h"
#include "server/mapped_file.h"
#include "server/preparation.h"
#include "server/result_writer.h"

namespace lpf::server {
namespace {

/// Where on the progress bar each part of a job ends [percent].
constexpr double kDecoded = 3;
constexpr double kPrepared = 5;
constexpr double kMeasured = 8;
constexpr double kComputed = 90;
constexpr double kWritten = 99;

/// Notes how long each phase took, for the report.
class PhaseTimes {
public:
    void end_of(const std::string& phase) {
        seconds_.emplace_back(phase, seconds_since(start_));
        start_ = Clock::now();
    }
    [[nodiscard]] const auto& seconds() const { return seconds_; }

private:
    Clock::time_point start_ = Clock::now();
    std::vector<std::pair<std::string, double>> seconds_;
};

void pass_on_warnings(RunningJob& job, const std::vector<Warning>& warnings) {
    for (const Warning& warning : warnings) job.warn(warning.code, warning.detail);
}

}  // namespace

DecodeLimits decode_limits(const Limits& limits) {
    DecodeLimits out;
    out.max_points = limits.points;
    out.max_faces = limits.faces;
    return out;
}

Runner::Runner(Storage& storage, RunnerOptions options)
    : storage_(storage), options_(std::move(options)) {}

JobOutcome Runner::run(RunningJob& job) const {
    const StatusInfo asked = job.info();
    const JobInputs& inputs = asked.parameters;
    PhaseTimes times;

    job.enter_phase("decode", 0);
    Document document = load_shape(asked.shape, execution(job, 0, kDecoded));
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
    const ResolvedParameters parameters = resolve(job, document, report.measurements);
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

    finish_report(report, result, job.info());
    report.phase_seconds = times.seconds();
    report.total_seconds = job.seconds();
    writer.add_report(report);
    JobOutcome outcome = writer.take_outcome();
    outcome.phase_seconds = times.seconds();
    return outcome;
}

Document Runner::load_shape(const std::string& shape_id, const Execution& execution) const {
    const auto shape = storage_.jobs().find_shape(shape_id);
    if (!shape)
        throw ProblemException(ProblemCode::ShapeNotFound, "The shape of this job was deleted.");
    const MappedFile file(storage_.blobs().local_file(shape->sha256));
    return decode(file.bytes(), decode_limits(options_.limits), execution);
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

ResolvedParameters Runner::resolve(RunningJob& job, const Document& document,
                                   const Measurements& measurements) const {
    const StatusInfo asked = job.info();
    ParameterRequest request = to_request(asked.parameters, measurements);
    if (asked.parameters.dictionary) {
        request.dictionary = load_dictionary(*asked.parameters.dictionary);
        request.keep_dictionary = asked.parameters.dictionary_mode == DictionaryMode::Fixed;
    }
    ResolvedParameters parameters =
        resolve_parameters(asked.process, document.shape, measurements, request);
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
