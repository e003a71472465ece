#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lpf::http {

/// Name and value pairs in the order in which they came.
using Fields = std::vector<std::pair<std::string, std::string>>;

/// Takes the next bytes of a body; false stops the reading.
using BodySink = std::function<bool(std::string_view)>;

/// The head of one part of a multipart/form-data body.
struct Part {
    std::string name;
    std::string filename;
    std::string content_type;
};

/// Called at the start of each part; false stops the reading.
using PartSink = std::function<bool(const Part&)>;

/// A request as the handlers see it. The body is not in memory: a handler streams it.
struct Request {
    std::string method;
    std::string path;    ///< percent-decoded, without the query
    Fields query;        ///< percent-decoded
    Fields headers;      ///< names in lower case
    std::string id;      ///< X-Request-Id, the client's if it is well formed; empty otherwise
    std::string route;   ///< pattern of the route that was found, for logs and metrics
    std::string client;  ///< address of the peer, for limits; never logged
    std::string key;     ///< name of the API key that the request showed; empty without keys
    std::vector<std::string> path_parameters;  ///< what the {} of the route matched, in order

    std::function<bool(const BodySink&)> read_body;
    std::function<bool(const PartSink&, const BodySink&)> read_multipart;

    /// True when the client has gone away or the server is leaving: waiting is of no use.
    std::function<bool()> abandoned;

    /// Value of a header (name in lower case), or nothing.
    [[nodiscard]] std::optional<std::string> header(std::string_view name) const;
    /// Value of the first query field of this name, or nothing.
    [[nodiscard]] std::optional<std::string> query_value(std::string_view name) const;
};

/// A body that grows while the client reads it, such as an event stream. Asked from one thread.
class Feed {
public:
    virtual ~Feed() = default;

    /// What there is to send now; empty if there is nothing new. Returns at once.
    virtual std::string next() = 0;
    /// True when nothing will come any more: what next() gave is the rest.
    [[nodiscard]] virtual bool ended() const = 0;
};

/// A part of a file that is sent as a body without loading it.
struct FileSlice {
    std::filesystem::path path;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
};

struct Response {
    int status = 200;
    std::string content_type;
    std::string body;
    std::optional<FileSlice> file;  ///< instead of `body`
    std::shared_ptr<Feed> feed;     ///< instead of `body`: sent until it has ended
    Fields headers;
    std::string problem = {};  ///< code of the problem that the body is, for logs and metrics

    /// Adds a header, or replaces the one of this name.
    Response& set(const std::string& name, std::string value);
    [[nodiscard]] std::optional<std::string> header(std::string_view name) const;
    /// Bytes of the body.
    [[nodiscard]] std::uint64_t length() const { return file ? file->length : body.size(); }
};

}  // namespace lpf::http
