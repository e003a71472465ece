#include "server/http/reception.h"

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <array>
#include <cerrno>

namespace lpf::http {
namespace {

constexpr auto kTick = std::chrono::milliseconds(100);
constexpr auto kFarewell = std::chrono::seconds(2);
constexpr std::size_t kMostSwallowed = 32U << 20;
constexpr int kAcceptedAtOnce = 64;  // before those who are in have their turn
constexpr auto kPause = std::chrono::milliseconds(100);

Problem head_too_slow() {
    return {.problem = ProblemCode::RequestTimeout,
            .detail = "The request's head took too long to arrive (headSeconds)."};
}

Problem no_room(Guests::Admission admission) {
    if (admission == Guests::Admission::ClientFull) {
        return {.problem = ProblemCode::RateLimited,
                .detail = "Too many connections from this address (connectionsPerClient).",
                .retry_after = 1};
    }
    return {.problem = ProblemCode::Unavailable,
            .detail = "Too many connections; try again in a second.",
            .retry_after = 1};
}

}  // namespace

Reception::Reception(const Limits& limits, Guests& guests, Calls calls)
    : limits_(limits), guests_(guests), calls_(std::move(calls)) {}

void Reception::start(int listening) {
    listening_ = listening;
    accepting_ = true;
    poller_.add(listening_, EPOLLIN);
    thread_ = std::jthread([this] { run(); });
}

void Reception::welcome_back(ConnectionPtr connection) {
    connection->input.shrink_to_fit();  // thousands may be idle
    Guest guest{.connection = std::move(connection)};
    guest.deadline = Clock::now() + std::chrono::seconds(limits_.keep_alive_seconds);
    const std::lock_guard lock(mutex_);
    returned_.push_back(std::move(guest));
    poller_.wake();
}

void Reception::see_off(ConnectionPtr connection) {
    ::shutdown(connection->socket.get(), SHUT_WR);
    Guest guest{.connection = std::move(connection), .departing = true};
    guest.connection->input = {};
    guest.deadline = Clock::now() + kFarewell;
    const std::lock_guard lock(mutex_);
    returned_.push_back(std::move(guest));
    poller_.wake();
}

void Reception::leave() {
    leaving_ = true;
    poller_.wake();
}

void Reception::stop() {
    stopping_ = true;
    poller_.wake();
    if (thread_.joinable()) thread_.join();
    const std::lock_guard lock(mutex_);
    returned_.clear();
}

void Reception::run() {
    auto next_expiry = Clock::now();
    while (!stopping_) {
        const bool nothing_to_time =
            present_.empty() && resume_ == Clock::time_point() && !leaving_;
        for (const int socket : poller_.wait(nothing_to_time ? std::chrono::hours(1) : kTick)) {
            if (socket == listening_) {
                let_in();
            } else {
                serve(socket);
            }
        }
        take_returned();
        if (Clock::now() < next_expiry) continue;
        next_expiry = Clock::now() + kTick;
        expire();
    }
    present_.clear();
}

void Reception::let_in() {
    for (int i = 0; i < kAcceptedAtOnce && accepting_ && !leaving_; ++i) {
        sockaddr_storage peer{};
        socklen_t size = sizeof(peer);
        Descriptor socket(::accept4(listening_, reinterpret_cast<sockaddr*>(&peer), &size,
                                    SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (socket.get() >= 0) {
            admit(std::move(socket), address_for_limits(peer));
        } else if (errno != EINTR && errno != ECONNABORTED) {
            pause_if_out_of_descriptors(errno);
            return;
        }
    }
}

/// Without this, the listening socket would stay ready and the thread would run in a circle.
void Reception::pause_if_out_of_descriptors(int error) {
    if (error == EAGAIN || error == EWOULDBLOCK) return;
    poller_.remove(listening_);
    accepting_ = false;
    resume_ = Clock::now() + kPause;
}

void Reception::admit(Descriptor socket, const std::string& address) {
    const auto admission = guests_.enter(socket.get(), address);
    if (admission == Guests::Admission::NoRoomAtAll) return;
    const int yes = 1;
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
    auto connection = std::make_unique<Connection>(std::move(socket), address, guests_);
    if (admission != Guests::Admission::Granted) {
        calls_.refuse(std::move(connection), no_room(admission));
        return;
    }
    Guest guest{.connection = std::move(connection)};
    guest.deadline = Clock::now() + std::chrono::seconds(limits_.head_seconds);
    take_up(std::move(guest));
}

void Reception::take_returned() {
    std::vector<Guest> returned;
    {
        const std::lock_guard lock(mutex_);
        returned.swap(returned_);
    }
    for (Guest& guest : returned) take_up(std::move(guest));
}

void Reception::take_up(Guest guest) {
    const int socket = guest.connection->socket.get();
    const bool has_input = !guest.connection->input.empty();
    Guest& present = present_.insert_or_assign(socket, std::move(guest)).first->second;
    poller_.add(socket, EPOLLIN | EPOLLRDHUP);
    if (has_input) find_head(socket, present);  // the next request has come with the last one
}

void Reception::serve(int socket) {
    const auto found = present_.find(socket);
    if (found == present_.end()) return;
    if (found->second.departing) {
        swallow(socket, found->second);
    } else {
        read_head(socket, found->second);
    }
}

void Reception::read_head(int socket, Guest& guest) {
    std::array<char, 8192> piece{};
    const auto n = ::recv(socket, piece.data(), piece.size(), 0);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) {
        release(socket);
        return;
    }
    std::string& input = guest.connection->input;
    if (input.empty() && guest.connection->served > 0)  // the idle time is over
        guest.deadline = Clock::now() + std::chrono::seconds(limits_.head_seconds);
    input.append(piece.data(), static_cast<std::size_t>(n));
    find_head(socket, guest);
}

void Reception::find_head(int socket, Guest& guest) {
    std::string& input = guest.connection->input;
    if (guest.seen == 0 && input.starts_with("\r\n")) input.erase(0, 2);  // RFC 9112, Sec. 2.2
    try {
        const auto end = end_of_head(input, guest.seen);
        if (end == std::string::npos && input.size() <= limits_.head_bytes) {
            guest.seen = input.size();
            return;
        }
        Arrival arrival;
        arrival.head = parse_head(std::string_view(input).substr(0, end), limits_);
        input.erase(0, end);
        arrival.connection = release(socket);
        ++arrival.connection->served;
        calls_.dispatch(std::move(arrival));
    } catch (const ProblemException& error) {
        refuse(socket, error.problem());
    }
}

void Reception::swallow(int socket, Guest& guest) {
    static thread_local std::array<char, 65536> waste;
    const auto n = ::recv(socket, waste.data(), waste.size(), 0);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    guest.swallowed += n > 0 ? static_cast<std::size_t>(n) : 0;
    if (n <= 0 || guest.swallowed > kMostSwallowed) release(socket);
}

void Reception::expire() {
    const auto now = Clock::now();
    if (resume_ != Clock::time_point() && now >= resume_ && !leaving_) {
        resume_ = {};
        accepting_ = true;
        poller_.add(listening_, EPOLLIN);
    }
    if (leaving_ && accepting_) {
        poller_.remove(listening_);
        accepting_ = false;
        resume_ = {};
    }
    std::vector<int> late;
    for (const auto& [socket, guest] : present_) {
        const bool idle = !guest.departing && guest.connection->input.empty();
        if (now >= guest.deadline || (leaving_ && idle)) late.push_back(socket);
    }
    for (const int socket : late) time_out(socket, present_.at(socket));
}

void Reception::time_out(int socket, const Guest& guest) {
    if (guest.departing || guest.connection->input.empty()) {
        release(socket);
    } else {
        refuse(socket, head_too_slow());
    }
}

ConnectionPtr Reception::release(int socket) {
    const auto found = present_.find(socket);
    ConnectionPtr connection = std::move(found->second.connection);
    poller_.remove(socket);
    present_.erase(found);
    return connection;
}

void Reception::refuse(int socket, const Problem& problem) {
    calls_.refuse(release(socket), problem);
}

}  // namespace lpf::http
