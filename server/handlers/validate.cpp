// POST /v1/processes/{id}/validate: what a job would do and take. Nothing is queued or kept.
#include <nlohmann/json.hpp>

#include "api/codec/format.h"
#include "api/http_text.h"
#include "api/json_text.h"
#include "api/parameters.h"
#include "api/validation.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/ingest.h"
#include "server/requests/lookup.h"
#include "server/requests/outlook.h"
#include "server/store/mapped_file.h"
#include "server/work/result_writer.h"

namespace lpf::server {
namespace {

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

void require_workable(const Subject& subject) {
    ShapeInfo info;
    info.points = subject.points;
    info.bounds = subject.bounds;
    server::require_workable(info);
}

/// Of a Draco result; positions of other formats are not rounded to a lattice.
int quantization_bits(const Subject& subject, const Validation& v) {
    if (subject.streamed) return 0;
    return server::quantization_bits(v.parameters, subject.document.shape.cloud.points,
                                     v.measurements.mean_spacing);
}

OddPoints odd_points(const Document& document, const Findings& found) {
    const auto& attributes = document.shape.cloud.attributes;
    const bool normals = std::ranges::find(attributes, "nx", &Attribute::name) != attributes.end();
    return {found.duplicates, found.outliers, normals};
}

/// Fills in all that follows from the shape.
void fill_in(Services& services, const Subject& subject, Outlook outlook, Validation& v) {
    const Document& document = subject.document;
    v.format = file_extension(document.format);
    v.points = subject.points;
    v.faces = document.face_count();
    v.examined_share = outlook.examined_share;
    v.measurements = outlook.measurements;
    v.resolved_parameters = resolved_parameters(outlook.parameters.values);
    v.threads = services.config.threads;
    v.work = outlook.work;
    v.estimate = outlook.estimate;
    v.attributes =
        plan_attributes(v.process, document, v.parameters, quantization_bits(subject, v));
    const OddPoints odd = odd_points(document, outlook.found);
    v.neighbours = {outlook.parameters.analysis.radius, std::move(outlook.found.neighbours)};
    const auto limit = static_cast<double>(services.limits().job_seconds);
    v.warnings = document.warnings;
    const Allowance allowed{std::min(v.parameters.max_seconds.value_or(limit), limit),
                            static_cast<double>(services.limits().memory_bytes)};
    const auto more = foresee(v, odd, outlook.parameters.warnings, allowed);
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

    const MappedFile file(inquiry.file);
    const Question question{task, inquiry.inputs, file.bytes().size()};
    const DecodingRoom::Seat seat(services.decoding,
                                  subject_bytes(question, file, services.limits()));
    const Patience patience(request);
    const Subject subject = read_subject(question, file, services.limits(), {});
    require_workable(subject);
    check_result_size(inquiry.inputs, subject.points, services.limits());
    fill_in(services, subject, look_ahead(services, question, subject, patience), validation);
    return json_response(to_json(validation));
}

}  // namespace lpf::server
