// POST /v1/processes/{id}/validate: what a job would do and take. Nothing is queued or kept.
#include <nlohmann/json.hpp>
#include <thread>

#include "api/codec/format.h"
#include "api/http_text.h"
#include "api/json_text.h"
#include "api/parameters.h"
#include "api/validation.h"
#include "core/base/error.h"
#include "server/answer.h"
#include "server/examination.h"
#include "server/handlers/handlers.h"
#include "server/handlers/lookup.h"
#include "server/ingest.h"
#include "server/mapped_file.h"
#include "server/result_writer.h"
#include "server/runner.h"

namespace lpf::server {
namespace {

constexpr std::size_t kExaminedPoints = 200'000;
constexpr auto kPatience = std::chrono::seconds(30);
constexpr auto kPoll = std::chrono::milliseconds(100);

/// What is asked about which file.
struct Inquiry {
    JobInputs inputs;
    std::string shape;                   ///< ID, if it is a stored one
    std::unique_ptr<BlobWriter> upload;  ///< never committed: it goes when the answer is made
    std::filesystem::path file;
};

std::multimap<std::string, std::string> query_inputs(const http::Request& request) {
    return {request.query.begin(), request.query.end()};
}

Inquiry inquiry_from_json(Services& services, const http::Request& request, Task task) {
    allow_query(request, {});
    const std::string text = receive_text(services, request);
    ExecuteRequest wanted =
        execute_request_from_json(task, parse_json(text, services.limits()), services.limits());
    const ShapeInfo shape = require_shape(services, wanted.shape);
    return {std::move(wanted.inputs), shape.id, nullptr,
            services.storage.blobs().local_file(shape.sha256)};
}

Inquiry inquiry_from_body(Services& services, const http::Request& request, Task task, bool form) {
    auto fields = query_inputs(request);
    Inquiry inquiry;
    if (!form) inquiry.inputs = inputs_from_query(task, fields, services.limits());
    Upload upload = form ? receive_form(services, request) : receive_file(services, request);
    fields.merge(upload.fields);
    if (form) inquiry.inputs = inputs_from_query(task, fields, services.limits());
    inquiry.upload = std::move(upload.file);
    inquiry.file = inquiry.upload->staged();
    return inquiry;
}

Inquiry read_inquiry(Services& services, const http::Request& request, Task task) {
    const std::string type = bare_media_type(request.header("content-type").value_or(""));
    if (type == "application/json") return inquiry_from_json(services, request, task);
    return inquiry_from_body(services, request, task, type == "multipart/form-data");
}

/// Ends the work when nobody waits for its outcome any more, or it takes too long.
class Watch {
public:
    explicit Watch(const http::Request& request)
        : thread_([this, &request](const std::stop_token& done) {
              const auto deadline = Clock::now() + kPatience;
              while (!done.stop_requested()) {
                  const bool left = request.abandoned && request.abandoned();
                  if (left || Clock::now() >= deadline) stop_.request_stop();
                  std::this_thread::sleep_for(kPoll);
              }
          }) {}

    [[nodiscard]] Execution execution() const { return {.threads = 1, .stop = stop_.get_token()}; }

private:
    std::stop_source stop_;
    std::jthread thread_;  // last: it uses the source, and is joined first
};

void require_workable(const Document& document) {
    ShapeInfo info;
    info.points = document.shape.size();
    if (info.points > 0) info.bounds = bounds_of(document.shape.cloud.points);
    server::require_workable(info);
}

ResolvedParameters resolve(Services& services, Task task, const JobInputs& inputs,
                           const Shape& shape, const Measurements& measured) {
    ParameterRequest wanted = to_request(inputs, measured);
    if (inputs.dictionary) wanted.dictionary = load_dictionary(services, *inputs.dictionary);
    return resolve_parameters(task, shape, measured, wanted);
}

Workload workload_of(const Validation& v, const Document& document, const Findings& found,
                     const ResolvedParameters& parameters, std::uint64_t file_bytes) {
    const bool draco = document.format == FileFormat::Draco ||
                       result_format(v.parameters, document.format) == FileFormat::Draco;
    const auto points = static_cast<double>(v.points);
    return {.task = v.process,
            .points = points,
            .file_bytes = static_cast<double>(file_bytes),
            .row_bytes = attribute_row_bytes(document.shape.cloud),
            .faces = static_cast<double>(document.shape.triangles.cols()),
            .probed_points = found.probed_points,
            .fields = found.fields,
            .points_per_field = found.points_per_field,
            .output_points = expected_points(v.process, points, found.fields, parameters),
            .decoded_apart = draco,
            .finds_outliers =
                v.parameters.outliers.value_or(OutlierPolicy::Keep) != OutlierPolicy::Keep,
            .estimates_normals = v.parameters.normals == NormalPolicy::Estimate};
}

OddPoints odd_points(const Document& document, const Findings& found) {
    const auto& attributes = document.shape.cloud.attributes;
    const bool normals = std::ranges::find(attributes, "nx", &Attribute::name) != attributes.end();
    return {found.duplicates, found.outliers, normals};
}

/// Fills in all that follows from the shape.
void look_at(Services& services, const Document& document, std::uint64_t file_bytes,
             const Execution& execution, Validation& v) {
    v.format = file_extension(document.format);
    v.points = document.shape.size();
    v.faces = document.face_count();
    const ShapePart part = part_of_shape(document.shape, kExaminedPoints);
    v.examined_share = part.share;
    v.measurements = measure_part(part, document.shape, execution);
    const ResolvedParameters parameters =
        resolve(services, v.process, v.parameters, document.shape, v.measurements);
    v.resolved_parameters = resolved_parameters(parameters.values);
    Findings found = examine(part, parameters, execution);
    v.threads = services.config.threads;
    v.work = workload_of(v, document, found, parameters, file_bytes);
    v.estimate = estimate(v.work, parameters, machine_speed(), v.threads);
    v.neighbours = {parameters.analysis.radius, std::move(found.neighbours)};
    v.attributes = plan_attributes(
        v.process, document, v.parameters,
        quantization_bits(v.parameters, document.shape.cloud.points, v.measurements.mean_spacing));
    const auto limit = static_cast<double>(services.limits().job_seconds);
    v.warnings = document.warnings;
    const auto more = foresee(v, odd_points(document, found), parameters.warnings,
                              std::min(v.parameters.max_seconds.value_or(limit), limit));
    v.warnings.insert(v.warnings.end(), more.begin(), more.end());
}

}  // namespace

http::Response validate_process(Services& services, http::Request& request) {
    const Task task = require_process(request.path_parameters.at(0));
    const Inquiry inquiry = read_inquiry(services, request, task);
    Validation validation;
    validation.process = task;
    validation.shape = inquiry.shape;
    validation.parameters = inquiry.inputs;

    const DecoderSeat seat(services);
    const Watch watch(request);
    const std::uint64_t file_bytes = std::filesystem::file_size(inquiry.file);
    Document document;
    {
        const MappedFile file(inquiry.file);
        document = decode(file.bytes(), decode_limits(services.limits()));
    }
    require_workable(document);
    check_result_size(inquiry.inputs, document.shape.size(), services.limits());
    try {
        look_at(services, document, file_bytes, watch.execution(), validation);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::Cancelled) throw;
        throw ProblemException(ProblemCode::TimedOut, "Looking at this shape took too long.");
    }
    return json_response(to_json(validation));
}

}  // namespace lpf::server
