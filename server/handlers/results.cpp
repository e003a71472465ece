#include "api/results.h"

#include <array>
#include <nlohmann/json.hpp>

#include "api/http_text.h"
#include "api/memory_need.h"
#include "core/shape/noise.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/lookup.h"
#include "server/store/mapped_file.h"
#include "server/work/result_writer.h"

namespace lpf::server {
namespace {

constexpr std::string_view kAnyBytes = "application/octet-stream";

const ResultFile& require_file(const StoredJob& job, ResultKind kind) {
    for (const ResultFile& file : job.results)
        if (file.kind == kind) return file;
    throw ProblemException(ProblemCode::ResultNotFound, "A job of this process has no result '" +
                                                            std::string(result_name(kind)) + "'.");
}

std::string filename(const StoredJob& job, ResultKind kind, std::string_view extension) {
    return std::string(result_name(kind)) + "-" + job.info.job_id + "." + std::string(extension);
}

bool is_draco(const ResultFile& file) { return file.type == media_type(FileFormat::Draco); }

/// The format that a client wants the points in; nothing: as they are stored.
std::optional<FileFormat> wanted_format(const http::Request& request, const ResultFile& stored) {
    if (const auto name = request.query_value("format")) {
        const auto format = parse_format_name(*name);
        if (!format) throw query_problem("format", "It is one of ply ply-ascii drc.");
        return format;
    }
    const FileFormat other = is_draco(stored) ? FileFormat::PlyBinary : FileFormat::Draco;
    const std::array<std::string_view, 3> offers{stored.type, kAnyBytes, media_type(other)};
    const auto best = best_offer(request.header("accept").value_or(""), offers);
    if (!best) {
        throw ProblemException(ProblemCode::NotAcceptable,
                               "The points come as application/ply or application/vnd.draco.");
    }
    return *best == 2 ? std::optional(other) : std::nullopt;
}

/// Bits that keep the points apart, or 0 (exact) where there is no spacing to go by.
int bits_for(const Points& points, const JobInputs& inputs) {
    try {
        return quantization_bits(inputs, points, measure(points, {}).mean_spacing);
    } catch (const Error&) {
        return 0;
    }
}

std::string convert(Services& services, const ResultFile& stored, FileFormat format,
                    const JobInputs& inputs) {
    const MappedFile file(services.storage.blobs().local_file(stored.sha256));
    const DecodingRoom::Seat seat(services.decoding,
                                  2 * decoding_bytes(file.bytes(), services.limits()));
    DecodeLimits own_file;  // written here: it may be larger than what strangers may send
    own_file.max_points = own_file.max_faces = UINT32_MAX;
    own_file.decode_helper.clear();
    const Document document = decode(file.bytes(), own_file);
    EncodeOptions options;
    options.format = format;
    options.double_positions = document.double_positions;
    if (format == FileFormat::Draco)
        options.quantization_bits = bits_for(document.shape.cloud.points, inputs);
    std::vector<Warning> lost;
    return encode(document, options, lost);
}

http::Response send_points(Services& services, const http::Request& request, const StoredJob& job) {
    const ResultFile& stored = require_file(job, ResultKind::Points);
    const auto format = wanted_format(request, stored);
    if (!format) return send_result(services, request, job, ResultKind::Points);
    return send_bytes(request, convert(services, stored, *format, job.info.parameters),
                      {.type = std::string(media_type(*format)),
                       .filename = filename(job, ResultKind::Points, file_extension(*format)),
                       .sha256 = {}});
}

http::Response get_result(Services& services, http::Request& request, ResultKind kind) {
    allow_query(request, {});
    return send_result(services, request, require_results(services, request.path_parameters.at(0)),
                       kind);
}

}  // namespace

http::Response send_result(Services& services, const http::Request& request, const StoredJob& job,
                           ResultKind kind) {
    const ResultFile& file = require_file(job, kind);
    const bool json = file.type == "application/json";
    return send_blob(request, services.storage.blobs(),
                     {.type = file.type,
                      .filename = filename(job, kind,
                                           json             ? "json"
                                           : is_draco(file) ? "drc"
                                                            : "ply"),
                      .sha256 = file.sha256});
}

http::Response list_results(Services& services, http::Request& request) {
    allow_query(request, {});
    const StoredJob job = require_results(services, request.path_parameters.at(0));
    return json_response(results_to_json(job.info.job_id, job.results));
}

http::Response get_points(Services& services, http::Request& request) {
    allow_query(request, {"format"});
    return send_points(services, request, require_results(services, request.path_parameters.at(0)));
}

http::Response get_dictionary_result(Services& services, http::Request& request) {
    return get_result(services, request, ResultKind::Dictionary);
}

http::Response get_report(Services& services, http::Request& request) {
    return get_result(services, request, ResultKind::Report);
}

http::Response get_fields(Services& services, http::Request& request) {
    return get_result(services, request, ResultKind::Fields);
}

}  // namespace lpf::server
