#pragma once

#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "api/problem.h"
#include "server/blob_store.h"
#include "server/http/message.h"

namespace lpf::server {

[[nodiscard]] http::Response json_response(const nlohmann::json& json, int status = 200);

/// A problem document that names the path and the id of the request.
[[nodiscard]] http::Response problem_response(Problem problem, const http::Request& request);

/// How a file is handed out.
struct FileHead {
    std::string type;      ///< media type
    std::string filename;  ///< suggested to the client
    std::string sha256;    ///< becomes the ETag
};

/// A stored file: with ETag, 304 for a client that has it, a single Range (206, 416), If-Range.
[[nodiscard]] http::Response send_blob(const http::Request& request, const BlobStore& blobs,
                                       const FileHead& head);

/// The same for any file. `head.sha256` may be any name that stands for exactly these bytes.
[[nodiscard]] http::Response send_file(const http::Request& request,
                                       const std::filesystem::path& path, const FileHead& head);

/// The same for bytes in memory.
[[nodiscard]] http::Response send_bytes(const http::Request& request, std::string bytes,
                                        const FileHead& head);

/// Refuses query fields that the path does not know: a misspelt one would else be passed over.
/// @throws ProblemException{MalformedRequest}
void allow_query(const http::Request& request, std::initializer_list<std::string_view> names);

/// A query field as a number in [1, maximum]; `otherwise` if it is absent.
/// @throws ProblemException{InvalidParameter}
[[nodiscard]] std::uint64_t query_number(const http::Request& request, std::string_view name,
                                         std::uint64_t maximum, std::uint64_t otherwise);

/// A problem about one query field.
[[nodiscard]] ProblemException query_problem(std::string_view name, const std::string& detail);

}  // namespace lpf::server
