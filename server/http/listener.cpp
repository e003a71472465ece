#include "server/http/listener.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "core/base/error.h"
#include "server/http/connection.h"
#include "server/http/task_pool.h"

namespace lpf::http {
namespace {

constexpr int kBacklog = 512;  // the library's own is 5: bursts would wait for seconds
constexpr std::size_t kSlice = 256 * 1024;

/// Lets a restarted server have its port at once. The library's own choice, SO_REUSEPORT, would let
/// two servers share a port in silence.
void reuse_address(socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

/// Sends a slice of a file piece by piece.
void stream_file(const FileSlice& slice, const std::string& type, httplib::Response& out) {
    const int file = ::open(slice.path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw Error(ErrorCode::StorageFailure, "A stored file cannot be opened.");
    auto provide = [file, start = slice.offset](size_t offset, size_t length,
                                                httplib::DataSink& sink) {
        std::string piece(std::min(length, kSlice), '\0');
        const auto at = static_cast<off_t>(start + offset);
        const auto n = ::pread(file, piece.data(), piece.size(), at);
        return n > 0 && sink.write(piece.data(), static_cast<size_t>(n));
    };
    out.set_content_provider(slice.length, type, provide, [file](bool) { ::close(file); });
}

void fill(const Response& response, httplib::Response& out) {
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    out.set_header("Date", http_date());
    if (response.file && response.file->length > 0) {
        stream_file(*response.file, response.content_type, out);
    } else if (!response.content_type.empty()) {
        out.set_content(response.body, response.content_type);
    }
    out.status = response.status;
}

/// The id that the client gave, if it is harmless in a log, else none.
std::string request_id(const Head& head) {
    for (const auto& [name, value] : head.headers) {
        const bool plain = !value.empty() && value.size() <= 64 &&
                           value.find_first_not_of(
                               "0123456789abcdefghijklmnopqrstuvwxyz"
                               "ABCDEFGHIJKLMNOPQRSTUVWXYZ-_.") == std::string::npos;
        if (name == "x-request-id" && plain) return value;
    }
    return {};
}

Request make_request(const Head& head) {
    Request request;
    request.method = head.method;
    request.path = head.path;
    request.query = head.query;
    request.headers = head.headers;
    request.id = request_id(head);
    return request;
}

void attach_body(Request& request, const httplib::ContentReader* reader) {
    request.read_body = [reader](const BodySink& sink) {
        if (!reader) return true;
        return (*reader)([&](const char* data, size_t n) { return sink({data, n}); });
    };
    request.read_multipart = [reader](const PartSink& part, const BodySink& sink) {
        if (!reader) return false;
        return (*reader)(
            [&](const httplib::MultipartFormData& head) {
                return part({head.name, head.filename, head.content_type});
            },
            [&](const char* data, size_t n) {
                return sink({data, n});
            });
    };
}

}  // namespace

class Listener::Server : public httplib::Server {
public:
    Server(ListenerOptions options, http::Handler handler, RefusalHandler refuse)
        : options_(std::move(options)), handler_(std::move(handler)), refuse_(std::move(refuse)) {
        set_keep_alive_max_count(1);
        set_tcp_nodelay(true);
        set_socket_options(reuse_address);
        set_payload_max_length(static_cast<size_t>(-1));  // handlers count the bytes themselves
        set_exception_handler([](const auto&, auto& response, const std::exception_ptr&) {
            response.headers.clear();  // the library would send the exception's text
            response.status = 500;
        });
        new_task_queue = [this] { return new TaskPool(options_.threads, options_.queue); };
        register_handlers();
    }

    int start() {
        if (options_.port == 0) {
            options_.port = bind_to_any_port(options_.host);
        } else if (!bind_to_port(options_.host, options_.port)) {
            options_.port = -1;
        }
        if (options_.port < 0 || ::listen(svr_sock_, kBacklog) != 0) {
            throw Error(ErrorCode::StorageFailure, "Cannot listen on " + options_.host +
                                                       ": is the port taken by another program?");
        }
        thread_ = std::jthread([this] { listen_after_bind(); });
        while (!is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return options_.port;
    }

    void end(std::chrono::milliseconds patience) {
        if (!thread_.joinable()) return;
        leaving_ = true;
        httplib::Server::stop();
        {
            std::unique_lock lock(mutex_);
            for (const auto& [socket, busy] : open_)
                if (!busy) ::shutdown(socket, SHUT_RD);  // it has asked for nothing yet
            if (!idle_.wait_for(lock, patience, [&] { return open_.empty(); })) {
                for (const auto& [socket, busy] : open_) ::shutdown(socket, SHUT_RDWR);
            }
        }
        thread_.join();
    }

private:
    void register_handlers() {
        const auto plain = [this](const auto&, auto& out) { answer(nullptr, out); };
        const auto with_body = [this](const auto&, auto& out, const auto& reader) {
            answer(&reader, out);
        };
        Get("/", plain).Options("/", plain).Delete("/", httplib::Server::Handler(plain));
        Delete("/", HandlerWithContentReader(with_body));
        Post("/", HandlerWithContentReader(with_body));
        Put("/", HandlerWithContentReader(with_body));
        Patch("/", HandlerWithContentReader(with_body));
    }

    /// Called by the library, on the connection's thread, once it has seen the transport head.
    void answer(const httplib::ContentReader* reader, httplib::Response& out) {
        attach_body(*current_, reader);
        fill(handler_(*current_), out);
    }

    bool process_and_close_socket(socket_t socket) override {
        track(socket, false);
        Connection connection(socket, options_);
        try {
            serve(connection);
        } catch (const ProblemException& refusal) {
            connection.send(refuse_(refusal.problem()));
            if (!TaskPool::refusing() && !leaving_) connection.linger();
        } catch (...) {  // nothing may end the pool's thread
        }
        untrack(socket);
        ::close(socket);
        return true;
    }

    void serve(Connection& connection) {
        if (TaskPool::refusing() || leaving_) {
            throw ProblemException(
                {.problem = ProblemCode::Unavailable,
                 .detail = "Too many connections are waiting; try again in a second.",
                 .retry_after = 1});
        }
        const std::string text = connection.read_head();
        if (text.empty()) return;
        track(connection.socket(), true);
        const Head head = parse_head(text, options_.limits);
        Request request = make_request(head);
        request.abandoned = [&] { return leaving_ || connection.abandoned(); };
        connection.put_in_front(transport_head(head));
        current_ = &request;
        bool closed = false;
        process_request(connection, true, closed, nullptr);
        if (head.has_body()) connection.linger();
    }

    void track(int socket, bool busy) {
        const std::lock_guard lock(mutex_);
        open_[socket] = busy;
    }

    void untrack(int socket) {
        const std::lock_guard lock(mutex_);
        open_.erase(socket);
        idle_.notify_all();
    }

    ListenerOptions options_;
    http::Handler handler_;  // not httplib's, which has the same name
    RefusalHandler refuse_;
    std::atomic<bool> leaving_ = false;
    std::mutex mutex_;
    std::condition_variable idle_;
    std::map<int, bool> open_;  // sockets, and whether they have sent a request
    std::jthread thread_;

    // The library hands its own request to the handlers; ours waits here for the same thread.
    static thread_local Request* current_;
};

thread_local Request* Listener::Server::current_ = nullptr;

Listener::Listener(ListenerOptions options, Handler handler, RefusalHandler refuse)
    : server_(std::make_unique<Server>(std::move(options), std::move(handler), std::move(refuse))) {
}

Listener::~Listener() { stop(std::chrono::seconds(1)); }

int Listener::start() { return server_->start(); }

void Listener::stop(std::chrono::milliseconds patience) { server_->end(patience); }

}  // namespace lpf::http
