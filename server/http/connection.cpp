#include "server/http/connection.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace lpf::http {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kLingerTime = std::chrono::seconds(2);

/// Waits until `events` happen. @returns false at the deadline
bool wait_for(int socket, short events, Clock::time_point deadline) {
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        pollfd entry{socket, events, 0};
        const int ready = ::poll(&entry, 1, static_cast<int>(std::max<long>(left, 0)));
        if (ready > 0) return true;
        if (ready == 0 || errno != EINTR) return false;
    }
}

}  // namespace

Connection::Connection(int socket, const ListenerOptions& options)
    : socket_(socket),
      options_(options),
      body_deadline_(Clock::now() + std::chrono::seconds(options.limits.body_seconds)) {}

std::string Connection::read_head() {
    const auto deadline = Clock::now() + options_.head_deadline;
    std::array<char, 4096> chunk{};
    for (;;) {
        if (const auto end = end_of_head(buffered_); end != std::string::npos) {
            std::string head = buffered_.substr(0, end);
            buffered_.erase(0, end);
            return head;
        }
        if (buffered_.size() > options_.limits.head_bytes) {
            throw ProblemException(ProblemCode::HeadTooLarge,
                                   "The request's head is larger than " +
                                       std::to_string(options_.limits.head_bytes) + " bytes.");
        }
        if (!wait_for(socket_, POLLIN, deadline)) {
            if (buffered_.empty()) return {};
            throw ProblemException(ProblemCode::RequestTimeout,
                                   "The request's head took too long to arrive.");
        }
        const auto n = ::recv(socket_, chunk.data(), chunk.size(), 0);
        if (n <= 0) return {};
        buffered_.append(chunk.data(), static_cast<std::size_t>(n));
    }
}

void Connection::send(const Response& response) {
    std::string text = "HTTP/1.1 " + std::to_string(response.status) + " Refused\r\n";
    for (const auto& [name, value] : response.headers) text += name + ": " + value + "\r\n";
    text += "Date: " + http_date() + "\r\nContent-Type: " + response.content_type +
            "\r\nContent-Length: " + std::to_string(response.body.size()) +
            "\r\nConnection: close\r\n\r\n" + response.body;
    std::size_t sent = 0;
    while (sent < text.size()) {
        const auto n = write(text.data() + sent, text.size() - sent);
        if (n <= 0) return;
        sent += static_cast<std::size_t>(n);
    }
}

void Connection::linger() {
    ::shutdown(socket_, SHUT_WR);
    const auto deadline = Clock::now() + kLingerTime;
    std::array<char, 65536> waste{};
    while (Clock::now() < deadline && wait_for(socket_, POLLIN, deadline)) {
        if (::recv(socket_, waste.data(), waste.size(), 0) <= 0) return;
    }
}

bool Connection::abandoned() const {
    pollfd entry{socket_, POLLRDHUP, 0};
    return ::poll(&entry, 1, 0) > 0 && (entry.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

bool Connection::is_readable() const {
    const auto stall = Clock::now() + std::chrono::seconds(options_.limits.body_idle_seconds);
    return !buffered_.empty() || wait_for(socket_, POLLIN, std::min(stall, body_deadline_));
}

bool Connection::is_writable() const {
    return wait_for(socket_, POLLOUT, Clock::now() + options_.write_stall);
}

ssize_t Connection::read(char* data, size_t size) {
    if (!buffered_.empty()) {
        const auto n = std::min(size, buffered_.size());
        std::memcpy(data, buffered_.data(), n);
        buffered_.erase(0, n);
        return static_cast<ssize_t>(n);
    }
    // The library reads heads of parts and chunks byte by byte: fetch more and give it out slowly.
    std::array<char, 16384> chunk{};
    if (!is_readable()) return -1;
    const bool direct = size >= chunk.size();
    const auto n = ::recv(socket_, direct ? data : chunk.data(), direct ? size : chunk.size(), 0);
    if (n <= 0 || direct) return n;
    const auto given = std::min(size, static_cast<std::size_t>(n));
    std::memcpy(data, chunk.data(), given);
    buffered_.assign(chunk.data() + given, static_cast<std::size_t>(n) - given);
    return static_cast<ssize_t>(given);
}

ssize_t Connection::write(const char* data, size_t size) {
    return is_writable() ? ::send(socket_, data, size, MSG_NOSIGNAL) : -1;
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
    ip.clear();  // an address is never asked of the library, and none is logged
    port = 0;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
    ip.clear();
    port = 0;
}

std::string http_date() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    ::gmtime_r(&now, &parts);
    std::array<char, 40> text{};
    // The C locale is the program's: day and month come in English, as HTTP wants them.
    const auto n = std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts);
    return {text.data(), n};
}

}  // namespace lpf::http
