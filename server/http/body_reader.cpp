#include "server/http/body_reader.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>

#include "api/problem.h"
#include "server/http/multipart.h"

namespace lpf::http {
namespace {

constexpr std::size_t kPiece = 64 * 1024;
constexpr auto kGrace = std::chrono::seconds(10);  // before the rate is looked at

[[noreturn]] void refuse_slow(const std::string& detail) {
    throw ProblemException(ProblemCode::RequestTimeout, detail);
}

void require_small(std::uint64_t bytes, std::uint64_t limit) {
    if (bytes <= limit) return;
    throw ProblemException(
        ProblemCode::PayloadTooLarge,
        "The body is larger than the limit of " + std::to_string(limit) + " bytes (uploadBytes).");
}

}  // namespace

BodyReader::BodyReader(Connection& connection, const Head& head, const Limits& limits)
    : connection_(connection),
      head_(head),
      limits_(limits),
      left_(head.content_length.value_or(0)) {
    if (head.gzip) inflater_.emplace();
}

bool BodyReader::read(const BodySink& sink) {
    while (!finished()) {
        if (connection_.input.empty() && !fetch()) return false;
        if (!unframe(sink)) return false;
    }
    if (inflater_ && received_ > 0 && !inflater_->finished()) {
        throw ProblemException(ProblemCode::MalformedRequest,
                               "The body ends before its gzip does.");
    }
    return true;
}

bool BodyReader::read_form(const PartSink& part, const BodySink& sink) {
    const auto type = std::find_if(head_.headers.begin(), head_.headers.end(),
                                   [](const auto& f) { return f.first == "content-type"; });
    const std::string& text = type == head_.headers.end() ? std::string() : type->second;
    MultipartSplitter splitter(multipart_boundary(text), {}, part, sink);
    const bool complete = read([&](std::string_view piece) { return splitter.add(piece); });
    if (complete && !splitter.finished()) {
        throw ProblemException(ProblemCode::MalformedRequest,
                               "The form lacks the boundary that ends it.");
    }
    return complete;
}

/// Tells a client that waits for it to send its body: as late as this, so that whatever can be
/// refused by the head alone was refused.
void BodyReader::invite() {
    if (!head_.expects_continue || invited_) return;
    invited_ = true;
    std::string_view text = "HTTP/1.1 100 Continue\r\n\r\n";
    send_some(connection_.socket.get(), text);
}

void BodyReader::keep_pace() const {
    const auto time = Clock::now() - begin_;
    if (time > std::chrono::seconds(limits_.body_seconds)) {
        refuse_slow("The body took longer than " + std::to_string(limits_.body_seconds) +
                    " seconds (bodySeconds).");
    }
    const double seconds = std::chrono::duration<double>(time).count();
    const auto least = static_cast<double>(limits_.body_rate_floor) * seconds;
    if (time > kGrace && static_cast<double>(received_) < least) {
        refuse_slow("The body comes with less than " + std::to_string(limits_.body_rate_floor) +
                    " bytes a second (bodyRateFloor).");
    }
}

bool BodyReader::fetch() {
    invite();
    keep_pace();
    const int socket = connection_.socket.get();
    const auto idle = std::chrono::seconds(limits_.body_idle_seconds);
    if (!wait_for(socket, POLLIN, Clock::now() + idle)) {
        refuse_slow("Nothing of the body came for " + std::to_string(limits_.body_idle_seconds) +
                    " seconds (bodyIdleSeconds).");
    }
    std::string& input = connection_.input;
    input.resize(kPiece);
    const auto n = ::recv(socket, input.data(), input.size(), 0);
    const bool nothing_yet = n < 0 && (errno == EAGAIN || errno == EINTR);
    input.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return n > 0 || nothing_yet;
}

bool BodyReader::unframe(const BodySink& sink) {
    std::string_view input = connection_.input;
    const auto give = [&](std::string_view piece) { return unpack(piece, sink); };
    bool wanted = true;
    intact_ = false;
    if (head_.chunked) {
        wanted = chunks_.decode(input, give);
    } else {
        const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(left_, input.size()));
        left_ -= n;
        const std::string_view piece = input.substr(0, n);
        input.remove_prefix(n);
        wanted = n == 0 || give(piece);
    }
    connection_.input.erase(0, connection_.input.size() - input.size());
    intact_ = true;
    return wanted;
}

bool BodyReader::unpack(std::string_view piece, const BodySink& sink) {
    received_ += piece.size();
    require_small(received_, limits_.upload_bytes);
    if (!inflater_) return sink(piece);
    return inflater_->add(piece, [&](std::string_view data) {
        inflated_ += data.size();
        require_small(inflated_, limits_.upload_bytes);
        return sink(data);
    });
}

}  // namespace lpf::http
