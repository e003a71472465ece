// GET /v1/jobs/{id}/preview and /v1/shapes/{id}/preview: a fair share of the points, to draw.
#include "api/codec/preview.h"

#include <sstream>

#include "api/memory_need.h"
#include "server/handlers/handlers.h"
#include "server/requests/answer.h"
#include "server/requests/lookup.h"
#include "server/shapes/streaming.h"
#include "server/store/mapped_file.h"

namespace lpf::server {
namespace {

constexpr std::uint64_t kDefaultPoints = 200'000;
constexpr std::uint64_t kMostPoints = 2'000'000;

/// A file to be shown.
struct Source {
    std::string sha256;
    std::string of;    ///< input or result
    bool own = false;  ///< written by this server: it may be larger than what strangers may send
};

Source input_of(Services& services, const StatusInfo& job) {
    return {require_shape(services, job.shape).sha256, "input"};
}

/// The points of a job, or nothing if its process makes none.
std::optional<Source> result_of(const StoredJob& job) {
    for (const ResultFile& file : job.results)
        if (file.kind == ResultKind::Points) return Source{file.sha256, "result", true};
    return std::nullopt;
}

Source source_of(Services& services, const http::Request& request) {
    const std::string& id = request.path_parameters.at(0);
    const auto of = request.query_value("of");
    if (of && *of != "input" && *of != "result")
        throw query_problem("of", "It is one of input result.");
    if (of == "result") {
        if (auto result = result_of(require_results(services, id))) return *result;
        throw ProblemException(ProblemCode::ResultNotFound,
                               "A job of this process makes no points; ask with of=input.");
    }
    const StoredJob job = require_job(services, id);
    auto result = result_of(job);
    if (!of && result && !job.results_expired) return *result;
    return input_of(services, job.info);
}

std::string make_preview(Services& services, const Source& source, std::size_t most) {
    const MappedFile file(services.storage.blobs().local_file(source.sha256));
    if (sniff(file.bytes()) != FileFormat::Draco) {
        if (const auto sample = sample_rows(file.bytes(), most)) return encode_preview(*sample);
    }
    const DecodingRoom::Seat seat(services.decoding,
                                  decoding_bytes(file.bytes(), services.limits()));
    DecodeLimits limits = decode_limits(services.limits());
    if (source.own) {
        limits.max_points = limits.max_faces = UINT32_MAX;
        limits.decode_helper.clear();
    }
    return encode_preview(sample_document(decode(file.bytes(), limits), most));
}

/// What the comments of the file say, for clients that do not read comments.
http::Response with_head(http::Response response, const PreviewHead& head, const Source& source) {
    std::ostringstream offset;
    offset.precision(17);
    offset << head.offset.x() << ' ' << head.offset.y() << ' ' << head.offset.z();
    response.set("Preview-Of", source.of);
    response.set("Preview-Points", std::to_string(head.points));
    response.set("Preview-Total-Points", std::to_string(head.total));
    response.set("Preview-Offset", offset.str());
    return response;
}

http::Response send_preview(Services& services, const http::Request& request,
                            const Source& source) {
    const std::uint64_t most = query_number(request, "maxPoints", kMostPoints, kDefaultPoints);
    // The same bytes always give the same preview: its name needs no look at it.
    const std::string name = source.sha256 + "-" + std::to_string(most);
    const FileHead head{
        .type = "application/ply",
        .filename = "preview-" + source.of + "-" + request.path_parameters.at(0) + ".ply",
        .sha256 = name};
    if (const auto kept = services.previews.find(name)) {
        const MappedFile file(*kept);
        return with_head(send_file(request, *kept, head), read_preview_head(file.bytes()), source);
    }
    std::string bytes = make_preview(services, source, most);
    services.previews.keep(name, bytes);
    const PreviewHead facts = read_preview_head(std::as_bytes(std::span(bytes)));
    return with_head(send_bytes(request, std::move(bytes), head), facts, source);
}

}  // namespace

http::Response get_job_preview(Services& services, http::Request& request) {
    allow_query(request, {"maxPoints", "of"});
    return send_preview(services, request, source_of(services, request));
}

http::Response get_shape_preview(Services& services, http::Request& request) {
    allow_query(request, {"maxPoints"});
    const ShapeInfo shape = require_shape(services, request.path_parameters.at(0));
    return send_preview(services, request, {shape.sha256, "input"});
}

}  // namespace lpf::server
