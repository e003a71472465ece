#include "server/requests/answer.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/http_text.h"
#include "api/json_text.h"
#include "server/store/sha256.h"

namespace lpf::server {
namespace {

/// Headers that every answer with this file has, 304 and 416 included.
http::Response file_response(const FileHead& head) {
    http::Response response;
    response.set("ETag", "\"" + head.sha256 + "\"");
    response.set("Accept-Ranges", "bytes");
    response.set("Cache-Control", "private, no-cache");
    response.set("Vary", "Accept");
    return response;
}

/// The part of the file that the request asks for. If-Range with another tag asks for the whole.
ByteRange wanted_range(const http::Request& request, const std::string& etag, std::uint64_t size) {
    const auto range = request.header("range");
    const auto condition = request.header("if-range");
    if (!range || (condition && *condition != etag)) return {};
    return parse_range(*range, size);
}

/// Decides status and headers. @returns false if there is no body to send
bool open_answer(const http::Request& request, const FileHead& head, std::uint64_t size,
                 http::Response& response, ByteRange& range) {
    const std::string etag = *response.header("ETag");
    const bool fetches = request.method == "GET" || request.method == "HEAD";
    if (fetches && etag_matches(request.header("if-none-match").value_or(""), etag, true)) {
        response.status = 304;
        return false;
    }
    if (fetches) range = wanted_range(request, etag, size);
    if (range.kind == ByteRange::Kind::Unsatisfiable) {
        const std::string whole = content_range(range, size);
        response = problem_response({.problem = ProblemCode::RangeNotSatisfiable,
                                     .detail = "The file has " + std::to_string(size) +
                                               " bytes; the range starts behind its end."},
                                    request);
        response.set("Content-Range", whole);
        return false;
    }
    response.content_type = head.type;
    response.set("Content-Disposition", content_disposition(head.filename));
    if (range.kind == ByteRange::Kind::Part) {
        response.status = 206;
        response.set("Content-Range", content_range(range, size));
    } else if (size > 0) {
        range.last = size - 1;
    }
    return true;
}

}  // namespace

http::Response json_response(const nlohmann::json& json, int status) {
    http::Response response;
    response.status = status;
    response.content_type = "application/json";
    response.body = dump_json(json) + "\n";
    return response;
}

http::Response problem_response(Problem problem, const http::Request& request) {
    if (problem.instance.empty()) problem.instance = request.path;
    problem.members.emplace_back("requestId", request.id);
    http::Response response = json_response(to_json(problem), problem.status());
    response.content_type = std::string(kProblemMediaType);
    response.problem = problem.code();
    if (problem.retry_after > 0) response.set("Retry-After", std::to_string(problem.retry_after));
    return response;
}

http::Response send_blob(const http::Request& request, const BlobStore& blobs,
                         const FileHead& head) {
    return send_file(request, blobs.local_file(head.sha256), head);
}

http::Response send_file(const http::Request& request, const std::filesystem::path& path,
                         const FileHead& head) {
    const std::uint64_t size = std::filesystem::file_size(path);
    http::Response response = file_response(head);
    ByteRange range;
    if (open_answer(request, head, size, response, range))
        response.file = http::FileSlice{path, range.first, size ? range.last - range.first + 1 : 0};
    return response;
}

http::Response send_bytes(const http::Request& request, std::string bytes, const FileHead& head) {
    FileHead named = head;
    if (named.sha256.empty()) named.sha256 = sha256_of(bytes);
    http::Response response = file_response(named);
    ByteRange range;
    if (open_answer(request, named, bytes.size(), response, range)) {
        const bool part = range.kind == ByteRange::Kind::Part;
        response.body =
            part ? bytes.substr(range.first, range.last - range.first + 1) : std::move(bytes);
    }
    return response;
}

void allow_query(const http::Request& request, std::initializer_list<std::string_view> names) {
    for (const auto& [name, value] : request.query) {
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw ProblemException({.problem = ProblemCode::MalformedRequest,
                                    .detail = "This path knows no query parameter '" + name + "'.",
                                    .errors = {{"/" + name, "It is not known here."}}});
    }
}

std::uint64_t query_number(const http::Request& request, std::string_view name,
                           std::uint64_t maximum, std::uint64_t otherwise) {
    const auto text = request.query_value(name);
    if (!text) return otherwise;
    const auto number = parse_number(*text);
    if (!number || *number < 1 || *number > maximum) {
        throw query_problem(
            name, "This must be a whole number from 1 to " + std::to_string(maximum) + ".");
    }
    return *number;
}

ProblemException query_problem(std::string_view name, const std::string& detail) {
    return ProblemException(
        {.problem = ProblemCode::InvalidParameter,
         .detail = "The query parameter '" + std::string(name) + "' is wrong. " + detail,
         .errors = {{"/" + std::string(name), detail}}});
}

}  // namespace lpf::server
