#include "server/http/event_streams.h"

#include <poll.h>

#include <array>
#include <cstdio>

namespace lpf::http {
namespace {

constexpr auto kTick = std::chrono::milliseconds(100);
constexpr auto kHeartbeat = std::chrono::seconds(15);  // proxies cut what is silent for a minute
constexpr std::size_t kMostUnsent = 256U * 1024;
constexpr int kSystemBuffer = 64 * 1024;  // else the system holds megabytes for each
constexpr std::string_view kComment = ":\n\n";

}  // namespace

EventStreams::EventStreams(const Limits& limits)
    : most_(limits.event_streams),
      most_per_owner_(limits.event_streams_per_client),
      stall_(limits.write_stall_seconds),
      thread_([this] { run(); }) {}

EventStreams::Admission EventStreams::reserve(const std::string& owner) {
    const std::lock_guard lock(mutex_);
    if (stopping_ || reserved_ >= most_) return Admission::HouseFull;
    std::uint64_t& of_owner = owners_[owner];
    if (most_per_owner_ > 0 && of_owner >= most_per_owner_) return Admission::ClientFull;
    ++of_owner;
    ++reserved_;
    return Admission::Granted;
}

void EventStreams::release(const std::string& owner) {
    const std::lock_guard lock(mutex_);
    const auto found = owners_.find(owner);
    if (--found->second == 0) owners_.erase(found);
    --reserved_;
}

void EventStreams::take(ConnectionPtr connection, Outgoing answer, const std::string& owner) {
    ::setsockopt(connection->socket.get(), SOL_SOCKET, SO_SNDBUF, &kSystemBuffer,
                 sizeof(kSystemBuffer));
    Stream stream{std::move(connection), std::move(answer.feed), owner, answer.chunked,
                  std::move(answer.text)};
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
    arriving_.push_back(std::move(stream));
    wake_.notify_one();
}

void EventStreams::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void EventStreams::run() {
    for (;;) {
        bool last = false;
        {
            std::unique_lock lock(mutex_);
            if (streams_.empty()) wake_.wait(lock, [&] { return stopping_ || !arriving_.empty(); });
            std::move(arriving_.begin(), arriving_.end(), std::back_inserter(streams_));
            arriving_.clear();
            last = stopping_;
        }
        std::erase_if(streams_, [&](Stream& stream) {
            if (advance(stream, last)) return false;
            if (!stream.unsent.empty()) stream.connection->give_up();
            release(stream.owner);
            return true;
        });
        if (last) break;
        if (!streams_.empty()) wait_for_clients();
    }
    streams_.clear();
}

/// Rests for a tick, or shorter if a client that has fallen behind reads on.
void EventStreams::wait_for_clients() const {
    std::vector<pollfd> behind;
    for (const Stream& stream : streams_)
        if (!stream.unsent.empty()) behind.push_back({stream.connection->socket.get(), POLLOUT, 0});
    const auto deadline = Clock::now() + kTick;
    ::poll(behind.data(), behind.size(), static_cast<int>(kTick.count()));
    // A client that reads little and often shall not make this thread run all the time.
    std::this_thread::sleep_for(std::min<Clock::duration>(kTick / 5, deadline - Clock::now()));
}

bool EventStreams::advance(Stream& stream, bool last) const {
    if (stream.connection->abandoned()) return false;
    if (!stream.complete) ask(stream, last);
    const auto now = Clock::now();
    if (stream.unsent.size() > kMostUnsent) return false;
    std::string_view rest = stream.unsent;
    const bool idle = rest.empty();
    if (!send_some(stream.connection->socket.get(), rest)) return false;
    if (idle || rest.size() < stream.unsent.size()) stream.moved = now;
    stream.unsent.erase(0, stream.unsent.size() - rest.size());
    if (stream.unsent.empty()) return !stream.complete;
    return now - stream.moved <= stall_;
}

/// Asks the feed for what is new, and sees to the heartbeat and the end.
void EventStreams::ask(Stream& stream, bool last) {
    const auto now = Clock::now();
    std::string text;
    try {
        // In this order, so that nothing is lost that came between the two.
        stream.complete = stream.feed->ended() || last;
        text = stream.feed->next();
    } catch (const std::exception&) {  // what it read from has failed: the client may come again
        stream.complete = true;
    }
    if (text.empty() && now - stream.written > kHeartbeat) text = kComment;
    if (!text.empty()) {
        stream.written = now;
        append(stream, text);
    }
    if (stream.complete && stream.chunked) stream.unsent += "0\r\n\r\n";
}

void EventStreams::append(Stream& stream, const std::string& text) {
    if (!stream.chunked) {
        stream.unsent += text;
        return;
    }
    std::array<char, 24> size{};
    const int n = std::snprintf(size.data(), size.size(), "%zx\r\n", text.size());
    stream.unsent.append(size.data(), static_cast<std::size_t>(n)).append(text).append("\r\n");
}

}  // namespace lpf::http
