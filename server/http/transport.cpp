#include "server/http/transport.h"

#include <fcntl.h>
#include <httplib.h>
#include <sys/socket.h>

#include <array>
#include <cstring>
#include <ctime>

#include "core/base/error.h"

namespace lpf::http {
namespace {

constexpr int kBacklog = 1024;                 // the library's own is 5: bursts would wait
constexpr std::size_t kLargeBody = 64 * 1024;  // what is not copied through the library

/// Lets a restarted server have its port at once. The library's own choice, SO_REUSEPORT, would let
/// two servers share a port in silence.
void reuse_address(socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

/// The time as the Date header has it.
std::string http_date() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    std::array<char, 40> text{};
    // The C locale is the program's: day and month come in English, as HTTP wants them.
    const auto n = std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
    return {text.data(), n};
}

/// What the library takes for a connection: it reads a head and writes an answer, in memory.
class Paper : public httplib::Stream {
public:
    explicit Paper(std::string request) : request_(std::move(request)) {}

    [[nodiscard]] bool is_readable() const override { return true; }
    [[nodiscard]] bool is_writable() const override { return true; }
    ssize_t read(char* data, size_t size) override {
        const auto n = std::min(size, request_.size() - read_);
        std::memcpy(data, request_.data() + read_, n);
        read_ += n;
        return static_cast<ssize_t>(n);
    }
    ssize_t write(const char* data, size_t size) override {
        answer.append(data, size);
        return static_cast<ssize_t>(size);
    }
    void get_remote_ip_and_port(std::string& ip, int& port) const override {
        ip.clear();
        port = 0;
    }
    void get_local_ip_and_port(std::string& ip, int& port) const override {
        ip.clear();
        port = 0;
    }
    [[nodiscard]] socket_t socket() const override { return INVALID_SOCKET; }

    std::string answer;

private:
    std::string request_;
    std::size_t read_ = 0;
};

bool is_compressible(const std::string& type) {
    return type.starts_with("text/") || type.find("json") != std::string::npos ||
           type.find("javascript") != std::string::npos || type.find("xml") != std::string::npos;
}

bool goes_by_itself(const Response& response) {
    return response.body.size() > kLargeBody && !is_compressible(response.content_type);
}

/// Ends the library's writing after the head: the body is sent by others.
bool stop_here(size_t, size_t, httplib::DataSink&) { return false; }

bool stop_chunks_here(size_t, httplib::DataSink&) { return false; }

void fill(const Response& response, httplib::Response& out) {
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    out.set_header("Date", http_date());
    const std::string& type = response.content_type;
    if (response.feed) {
        out.set_chunked_content_provider(type, stop_chunks_here);
    } else if ((response.file && response.file->length > 0) || goes_by_itself(response)) {
        out.set_content_provider(response.length(), type, stop_here);
    } else if (!type.empty()) {
        out.set_content(response.body, type);
    }
    out.status = response.status;
}

void attach_file(const FileSlice& slice, Outgoing& out) {
    out.file = Descriptor(::open(slice.path.c_str(), O_RDONLY | O_CLOEXEC));
    if (out.file.get() < 0)
        throw Error(ErrorCode::StorageFailure, "A stored file cannot be opened.");
    out.file_offset = slice.offset;
    out.file_left = slice.length;
}

/// Clients of HTTP/1.0 know no chunks: for them the end of the connection is the end of the feed.
void remove_chunking(std::string& head) {
    constexpr std::string_view kField = "Transfer-Encoding: chunked\r\n";
    const auto at = head.find(kField);
    if (at != std::string::npos) head.erase(at, kField.size());
}

}  // namespace

class Transport::Server : public httplib::Server {
public:
    Server() {
        set_socket_options(reuse_address);
        Get("/", [](const auto&, auto& out) { fill(*current_, out); });
    }

    int open(const std::string& host, int port) {
        if (port == 0) {
            port = bind_to_any_port(host);
        } else if (!bind_to_port(host, port)) {
            port = -1;
        }
        if (port < 0 || ::listen(svr_sock_, kBacklog) != 0) {
            throw Error(ErrorCode::StorageFailure,
                        "Cannot listen on " + host + ": is the port taken by another program?");
        }
        ::fcntl(svr_sock_, F_SETFL, O_NONBLOCK);
        ::fcntl(svr_sock_, F_SETFD, FD_CLOEXEC);
        return port;
    }

    void shut() {
        const int socket = svr_sock_.exchange(INVALID_SOCKET);
        if (socket != INVALID_SOCKET) ::close(socket);
    }

    [[nodiscard]] int socket() const { return svr_sock_; }

    std::string write(const std::string& head, const Response& response, bool keep_alive) {
        Paper paper(head);
        current_ = &response;
        bool closed = false;
        process_request(paper, !keep_alive, closed, nullptr);
        return std::move(paper.answer);
    }

private:
    // The library hands its own response to the handler; ours waits here for the same thread.
    static thread_local const Response* current_;
};

thread_local const Response* Transport::Server::current_ = nullptr;

Transport::Transport(const Limits& limits) : server_(std::make_unique<Server>()) {
    server_->set_keep_alive_timeout(static_cast<time_t>(limits.keep_alive_seconds));
    server_->set_keep_alive_max_count(limits.keep_alive_requests);
}

Transport::~Transport() { close(); }

int Transport::bind(const std::string& host, int port) { return server_->open(host, port); }

int Transport::socket() const { return server_->socket(); }

void Transport::refuse_connections() { ::shutdown(server_->socket(), SHUT_RDWR); }

void Transport::close() { server_->shut(); }

Outgoing Transport::render(const Head& head, Response response, bool keep_alive) {
    Outgoing out;
    if (response.file && response.file->length > 0) attach_file(*response.file, out);
    out.keep_alive = keep_alive && !response.feed;
    out.text = server_->write(transport_head(head), response, out.keep_alive);
    if (response.feed) out.chunked = !head.old;
    if (response.feed && head.old) remove_chunking(out.text);
    if (head.method == "HEAD") {
        out.file_left = 0;
    } else if (response.feed) {
        out.feed = std::move(response.feed);
    } else if (!response.file && goes_by_itself(response)) {
        out.body = std::move(response.body);
    }
    return out;
}

}  // namespace lpf::http
