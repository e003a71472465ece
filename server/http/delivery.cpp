#include "server/http/delivery.h"

#include <sys/sendfile.h>

#include <algorithm>
#include <cerrno>

namespace lpf::http {
namespace {

constexpr std::size_t kMemory = 64U << 20;  // for answers that wait for their readers
constexpr std::size_t kTurn = 1U << 20;     // of a file, before others have their turn
constexpr auto kTick = std::chrono::milliseconds(500);

}  // namespace

Delivery::Delivery(const Limits& limits, Done done)
    : stall_(limits.write_stall_seconds), done_(std::move(done)), thread_([this] { run(); }) {}

bool Delivery::has_room(const Outgoing& answer) const {
    const std::size_t held = held_;
    return held == 0 || held + answer.memory() <= kMemory;  // one is always let through
}

void Delivery::take(ConnectionPtr connection, Outgoing answer) {
    Parcel parcel{std::move(connection), std::move(answer)};
    switch (send(parcel)) {
        case Progress::Broken: parcel.connection->give_up(); return;
        case Progress::Sent: done_(std::move(parcel.connection), parcel.answer.keep_alive); return;
        case Progress::Waiting: break;
    }
    if (stopping_) return;
    held_ += parcel.answer.memory();
    {
        const std::lock_guard lock(mutex_);
        arriving_.push_back(std::move(parcel));
    }
    poller_.wake();
}

void Delivery::stop() {
    stopping_ = true;
    poller_.wake();
    if (thread_.joinable()) thread_.join();
    const std::lock_guard lock(mutex_);
    arriving_.clear();
}

void Delivery::run() {
    while (!stopping_) {
        for (const int socket : poller_.wait(parcels_.empty() ? std::chrono::hours(1) : kTick))
            advance(socket);
        accept_parcels();
        drop_stalled();
    }
    parcels_.clear();
}

void Delivery::accept_parcels() {
    std::vector<Parcel> arriving;
    {
        const std::lock_guard lock(mutex_);
        arriving.swap(arriving_);
    }
    for (Parcel& parcel : arriving) {
        const int socket = parcel.connection->socket.get();
        parcels_.emplace(socket, std::move(parcel));
        poller_.add(socket, EPOLLOUT);
    }
}

void Delivery::advance(int socket) {
    const auto found = parcels_.find(socket);
    if (found == parcels_.end()) return;
    Parcel& parcel = found->second;
    const Progress progress = send(parcel);
    if (progress == Progress::Waiting) return;
    ConnectionPtr connection = std::move(parcel.connection);
    const bool keep_alive = parcel.answer.keep_alive;
    forget(socket);
    if (progress == Progress::Sent) {
        done_(std::move(connection), keep_alive);
    } else {
        connection->give_up();
    }
}

void Delivery::drop_stalled() {
    const auto now = Clock::now();
    std::vector<int> stalled;
    for (const auto& [socket, parcel] : parcels_)
        if (now - parcel.moved > stall_) stalled.push_back(socket);
    for (const int socket : stalled) {
        parcels_.at(socket).connection->give_up();
        forget(socket);
    }
}

void Delivery::forget(int socket) {
    const auto found = parcels_.find(socket);
    poller_.remove(socket);
    held_ -= found->second.answer.memory();
    parcels_.erase(found);
}

Delivery::Progress Delivery::send(Parcel& parcel) {
    const Progress progress = send_memory(parcel);
    return progress == Progress::Sent ? send_file(parcel) : progress;
}

Delivery::Progress Delivery::send_memory(Parcel& parcel) {
    std::size_t begin = 0;
    for (const std::string* part : {&parcel.answer.text, &parcel.answer.body}) {
        if (parcel.sent < begin + part->size()) {
            std::string_view rest = std::string_view(*part).substr(parcel.sent - begin);
            const std::size_t before = rest.size();
            const bool alive = send_some(parcel.connection->socket.get(), rest);
            if (rest.size() < before) parcel.moved = Clock::now();
            parcel.sent += before - rest.size();
            if (!alive) return Progress::Broken;
            if (!rest.empty()) return Progress::Waiting;
        }
        begin += part->size();
    }
    return Progress::Sent;
}

Delivery::Progress Delivery::send_file(Parcel& parcel) {
    Outgoing& answer = parcel.answer;
    std::uint64_t turn = kTurn;
    while (answer.file_left > 0) {
        if (turn == 0) return Progress::Waiting;
        auto offset = static_cast<off_t>(answer.file_offset);
        const auto n = ::sendfile(parcel.connection->socket.get(), answer.file.get(), &offset,
                                  std::min(answer.file_left, turn));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return Progress::Waiting;
        if (n <= 0) return Progress::Broken;  // the client has left, or the file was cut
        const auto sent = static_cast<std::uint64_t>(n);
        answer.file_offset += sent;
        answer.file_left -= sent;
        turn -= sent;
        parcel.moved = Clock::now();
    }
    return Progress::Sent;
}

}  // namespace lpf::http
