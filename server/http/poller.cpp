#include "server/http/poller.h"

#include <sys/eventfd.h>

#include <array>

#include "core/base/error.h"

namespace lpf::http {

Poller::Poller()
    : poll_(::epoll_create1(EPOLL_CLOEXEC)), bell_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (poll_.get() < 0 || bell_.get() < 0)
        throw Error(ErrorCode::StorageFailure, "The system grants no more descriptors.");
    add(bell_.get(), EPOLLIN);
}

void Poller::add(int socket, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.fd = socket;
    ::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, socket, &event);
}

void Poller::remove(int socket) { ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, socket, nullptr); }

std::vector<int> Poller::wait(std::chrono::milliseconds time) {
    std::array<epoll_event, 256> events{};
    const int n = ::epoll_wait(poll_.get(), events.data(), static_cast<int>(events.size()),
                               static_cast<int>(time.count()));
    std::vector<int> ready;
    for (int i = 0; i < n; ++i) {
        const int socket = events[static_cast<std::size_t>(i)].data.fd;
        if (socket == bell_.get()) {
            std::uint64_t rings = 0;
            (void)!::read(socket, &rings, sizeof(rings));
        } else {
            ready.push_back(socket);
        }
    }
    return ready;
}

void Poller::wake() {
    const std::uint64_t ring = 1;
    (void)!::write(bell_.get(), &ring, sizeof(ring));
}

}  // namespace lpf::http
