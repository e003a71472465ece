#include "server/http/guests.h"

#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>

namespace lpf::http {
namespace {

constexpr std::uint64_t kDoorway = 256;      // those who are told that there is no room
constexpr std::uint64_t kOtherFiles = 1024;  // files, database, pipes to children

/// What the limit of open files leaves for connections.
std::uint64_t sockets_to_have() {
    const std::uint64_t files = raise_descriptor_limit();
    return files > 2 * kOtherFiles ? files - kOtherFiles : files / 2;
}

}  // namespace

Guests::Guests(const Limits& limits)
    : most_(std::min(limits.connections, sockets_to_have())),
      most_per_address_(limits.connections_per_client) {}

Guests::Admission Guests::enter(int socket, const std::string& address) {
    const std::lock_guard lock(mutex_);
    if (sockets_.size() >= most_ + std::min(kDoorway, most_)) return Admission::NoRoomAtAll;
    const bool full = sockets_.size() >= most_;
    sockets_.insert(socket);
    const std::uint64_t of_client = ++addresses_[address];
    if (most_per_address_ > 0 && of_client > most_per_address_) {
        // Nor may one client fill the doorway.
        if (of_client <= 2 * most_per_address_) return Admission::ClientFull;
        sockets_.erase(socket);
        --addresses_[address];
        return Admission::NoRoomAtAll;
    }
    return full ? Admission::HouseFull : Admission::Granted;
}

void Guests::leave(int socket, const std::string& address) {
    const std::lock_guard lock(mutex_);
    sockets_.erase(socket);
    const auto of_client = addresses_.find(address);
    if (of_client != addresses_.end() && --of_client->second == 0) addresses_.erase(of_client);
    if (sockets_.empty()) changed_.notify_all();
}

bool Guests::wait_until_empty(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [&] { return sockets_.empty(); });
}

void Guests::cut_all() {
    const std::lock_guard lock(mutex_);
    for (const int socket : sockets_) ::shutdown(socket, SHUT_RDWR);
}

std::uint64_t raise_descriptor_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return 1024;
    // More than this helps nobody, and some systems grant a billion.
    const rlim_t wanted = std::min<rlim_t>(limit.rlim_max, 65'536);
    if (limit.rlim_cur < wanted) {
        limit.rlim_cur = wanted;
        ::setrlimit(RLIMIT_NOFILE, &limit);
        ::getrlimit(RLIMIT_NOFILE, &limit);
    }
    return limit.rlim_cur;
}

}  // namespace lpf::http
