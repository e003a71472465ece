#include "server/http/listener.h"

#include <atomic>
#include <csignal>

#include "api/http_text.h"
#include "server/http/body_reader.h"
#include "server/http/delivery.h"
#include "server/http/event_streams.h"
#include "server/http/lane.h"
#include "server/http/reception.h"
#include "server/http/transport.h"

namespace lpf::http {
namespace {

Problem busy(const std::string& what) {
    return {.problem = ProblemCode::Unavailable,
            .detail = "Too many " + what + " at a time; try again in a second.",
            .retry_after = 1};
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

Request make_request(const Head& head, const Connection& connection) {
    Request request;
    request.method = head.method;
    request.path = head.path;
    request.query = head.query;
    request.headers = head.headers;
    request.id = request_id(head);
    request.client = connection.address;
    return request;
}

bool is_preference(const std::pair<std::string, std::string>& field) {
    return field.first == "prefer";
}

bool wants_to_wait(const Request& request) {
    return std::any_of(request.headers.begin(), request.headers.end(), [](const auto& field) {
        return is_preference(field) && prefer_wait(field.second, 1).has_value();
    });
}

}  // namespace

class Listener::House {
public:
    House(ListenerOptions options, http::Handler handler, RefusalHandler refusal)
        : options_(std::move(options)),
          handler_(std::move(handler)),
          refuse_(std::move(refusal)),
          guests_(options_.limits),
          transport_(options_.limits),
          streams_(options_.limits),
          reception_(options_.limits, guests_,
                     {[this](Arrival arrival) { dispatch(std::move(arrival)); },
                      [this](ConnectionPtr connection, const Problem& problem) {
                          refuse(std::move(connection), {}, problem);
                      }}),
          delivery_(options_.limits, [this](ConnectionPtr connection,
                                            bool keep) { part(std::move(connection), keep); }),
          quick_(lane(options_.threads, options_.queue)),
          long_(lane(options_.limits.long_requests_at_once, 0)),
          bodies_(lane(options_.limits.uploads_at_once, 0)) {
        std::signal(SIGPIPE, SIG_IGN);  // sendfile() knows no MSG_NOSIGNAL
    }

    int start() {
        const int port = transport_.bind(options_.host, options_.port);
        reception_.start(transport_.socket());
        return port;
    }

    void end(std::chrono::milliseconds patience) {
        if (leaving_.exchange(true)) return;
        reception_.leave();
        transport_.refuse_connections();
        streams_.stop();
        if (!guests_.wait_until_empty(patience)) guests_.cut_all();
        quick_.close();
        long_.close();
        bodies_.close();
        delivery_.stop();
        reception_.stop();
        transport_.close();
    }

private:
    [[nodiscard]] Lane lane(std::size_t threads, std::size_t queue) {
        return {threads, queue, [this](Arrival arrival) { serve(std::move(arrival)); }};
    }

    /// On the reception's thread.
    void dispatch(Arrival arrival) {
        if (arrival.head.has_body()) {
            enter(bodies_, std::move(arrival), "uploads");
            return;
        }
        const Request request = make_request(arrival.head, *arrival.connection);
        const Pace pace = options_.pace(request);
        if (pace == Pace::AtOnce) {
            serve(std::move(arrival));
        } else if (pace == Pace::Long) {
            enter(long_, std::move(arrival), "long requests");
        } else if (!wants_to_wait(request)) {
            enter(quick_, std::move(arrival), "requests");
        } else if (!long_.enter(arrival)) {
            // A preference need not be granted: this client has its answer now.
            std::erase_if(arrival.head.headers, is_preference);
            enter(quick_, std::move(arrival), "requests");
        }
    }

    void enter(Lane& lane, Arrival arrival, const std::string& what) {
        if (lane.enter(arrival)) return;
        refuse(std::move(arrival.connection), arrival.head, busy(what));
    }

    /// On a lane's thread.
    void serve(Arrival arrival) {
        Connection& connection = *arrival.connection;
        Request request = make_request(arrival.head, connection);
        BodyReader body(connection, arrival.head, options_.limits);
        request.read_body = [&](const BodySink& sink) { return body.read(sink); };
        request.read_multipart = [&](const PartSink& part, const BodySink& sink) {
            return body.read_form(part, sink);
        };
        request.abandoned = [&] { return leaving_ || connection.abandoned(); };
        Response response = answer(request);
        const bool keep_alive = arrival.head.keep_alive && body.finished() && !leaving_ &&
                                connection.served < options_.limits.keep_alive_requests;
        if (response.feed && arrival.head.method != "HEAD") {
            stream(std::move(arrival), std::move(response),
                   request.key.empty() ? request.client : "key " + request.key);
        } else {
            deliver(std::move(arrival.connection), arrival.head, std::move(response), keep_alive);
        }
    }

    Response answer(Request& request) {
        try {
            return handler_(request);
        } catch (...) {  // nothing may end the thread, and no text of an exception leaves it
            return refuse_({.problem = ProblemCode::Internal});
        }
    }

    void deliver(ConnectionPtr connection, const Head& head, Response response, bool keep_alive) {
        Outgoing out;
        try {
            out = transport_.render(head, std::move(response), keep_alive);
        } catch (...) {  // the file is gone
            out = transport_.render(head, refuse_({.problem = ProblemCode::StorageFailure}), false);
        }
        if (!delivery_.has_room(out))
            out = transport_.render(head, refuse_(busy("answers")), false);
        delivery_.take(std::move(connection), std::move(out));
    }

    void stream(Arrival arrival, Response response, const std::string& owner) {
        const auto admission = streams_.reserve(owner);
        if (admission == EventStreams::Admission::Granted) {
            Outgoing out = transport_.render(arrival.head, std::move(response), false);
            streams_.take(std::move(arrival.connection), std::move(out), owner);
            return;
        }
        Problem problem = busy("event streams");
        if (admission == EventStreams::Admission::ClientFull)
            problem.problem = ProblemCode::RateLimited;
        refuse(std::move(arrival.connection), arrival.head, problem);
    }

    void refuse(ConnectionPtr connection, const Head& head, const Problem& problem) {
        delivery_.take(std::move(connection), transport_.render(head, refuse_(problem), false));
    }

    /// After the whole answer.
    void part(ConnectionPtr connection, bool keep_alive) {
        if (keep_alive && !leaving_) {
            reception_.welcome_back(std::move(connection));
        } else {
            reception_.see_off(std::move(connection));
        }
    }

    ListenerOptions options_;
    http::Handler handler_;
    RefusalHandler refuse_;
    std::atomic<bool> leaving_ = false;
    Guests guests_;
    Transport transport_;
    EventStreams streams_;
    Reception reception_;
    Delivery delivery_;
    Lane quick_;
    Lane long_;
    Lane bodies_;
};

Listener::Listener(ListenerOptions options, Handler handler, RefusalHandler refusal)
    : house_(std::make_unique<House>(std::move(options), std::move(handler), std::move(refusal))) {}

Listener::~Listener() { stop(std::chrono::seconds(1)); }

int Listener::start() { return house_->start(); }

void Listener::stop(std::chrono::milliseconds patience) { house_->end(patience); }

}  // namespace lpf::http
