#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/http/descriptor.h"
#include "server/http/head.h"
#include "server/http/message.h"

namespace lpf::http {

/// An answer as it goes out: `text` first, then what follows it.
struct Outgoing {
    std::string text;  ///< head, and the body if it is small
    std::string body;  ///< a large one
    Descriptor file;
    std::uint64_t file_offset = 0;
    std::uint64_t file_left = 0;
    std::shared_ptr<Feed> feed;
    bool chunked = false;  ///< how the feed is framed
    bool keep_alive = false;

    [[nodiscard]] std::size_t memory() const { return text.size() + body.size(); }
};

/// The only user of cpp-httplib's server: it opens the port, and it writes answers (status line,
/// headers, compression). What Debian ships cannot be let near a socket: one slow client holds a
/// thread, accept() ends at the first aborted connection, and its body, multipart and range code
/// has known holes. So it works on texts, and this folder does the rest.
class Transport {
public:
    explicit Transport(const Limits& limits);
    ~Transport();
    Transport(const Transport&) = delete;
    Transport& operator=(const Transport&) = delete;

    /// Opens the port, which does not block. @param port 0 picks a free one
    /// @returns the port @throws Error{StorageFailure} when it cannot be had
    int bind(const std::string& host, int port);
    /// The listening socket.
    [[nodiscard]] int socket() const;
    /// Lets nobody connect any more; others may still wait at the socket.
    void refuse_connections();
    /// Closes the port.
    void close();

    /// Writes an answer; any number of threads may call.
    /// @param head of the request, which decides about compression and whether there is a body
    [[nodiscard]] Outgoing render(const Head& head, Response response, bool keep_alive);

private:
    class Server;
    std::unique_ptr<Server> server_;
};

}  // namespace lpf::http
