#include "server/requests/outlook.h"

#include "api/attribute_plan.h"
#include "core/base/error.h"
#include "server/requests/lookup.h"

namespace lpf::server {
namespace {

constexpr auto kPatience = std::chrono::seconds(30);
constexpr auto kPoll = std::chrono::milliseconds(100);

ResolvedParameters resolve(Services& services, const Question& q, const Shape& shape,
                           const Measurements& measured) {
    ParameterRequest wanted = to_request(q.inputs, measured);
    if (q.inputs.dictionary) wanted.dictionary = load_dictionary(services, *q.inputs.dictionary);
    return resolve_parameters(q.task, shape, measured, wanted);
}

Workload workload_of(const Question& q, const Subject& subject, const Findings& found,
                     const ResolvedParameters& parameters) {
    const Document& document = subject.document;
    const bool draco = document.format == FileFormat::Draco ||
                       result_format(q.inputs, document.format) == FileFormat::Draco;
    const auto points = static_cast<double>(subject.points);
    return {
        .task = q.task,
        .points = points,
        .file_bytes = static_cast<double>(q.file_bytes),
        .row_bytes = attribute_row_bytes(document.shape.cloud),
        .faces = static_cast<double>(document.shape.triangles.cols()),
        .probed_points = found.probed_points,
        .fields = found.fields,
        .points_per_field = found.points_per_field,
        .output_points = expected_points(q.task, points, found.fields, parameters),
        .decoded_apart = draco,
        .streamed = subject.streamed,
        .finds_outliers = q.inputs.outliers.value_or(OutlierPolicy::Keep) != OutlierPolicy::Keep,
        .estimates_normals = q.inputs.normals == NormalPolicy::Estimate};
}

Outlook look(Services& services, const Question& q, const Subject& subject,
             const Execution& execution) {
    Outlook out;
    const ShapePart& part = subject.part;
    out.examined_share = part.share;
    out.measurements = measure_part(part, subject.points, subject.diagonal(), execution);
    out.parameters = resolve(services, q, subject.document.shape, out.measurements);
    out.found = examine(part, out.parameters, execution);
    out.work = workload_of(q, subject, out.found, out.parameters);
    out.estimate = estimate(out.work, out.parameters, machine_speed(), services.config.threads);
    return out;
}

}  // namespace

Patience::Patience(const http::Request& request)
    : thread_([this, &request](const std::stop_token& done) {
          const auto deadline = Clock::now() + kPatience;
          while (!done.stop_requested()) {
              const bool left = request.abandoned && request.abandoned();
              if (left || Clock::now() >= deadline) stop_.request_stop();
              std::this_thread::sleep_for(kPoll);
          }
      }) {}

Outlook look_ahead(Services& services, const Question& question, const Subject& subject,
                   const Patience& patience) {
    try {
        return look(services, question, subject, patience.execution());
    } catch (const Error& error) {
        if (error.code() != ErrorCode::Cancelled) throw;
        throw ProblemException(ProblemCode::TimedOut, "Looking at this shape took too long.");
    }
}

}  // namespace lpf::server
