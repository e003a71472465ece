#include "server/http/lane.h"

#include <system_error>

namespace lpf::http {

Lane::Lane(std::size_t threads, std::size_t queue, std::function<void(Arrival)> serve)
    : most_threads_(threads), most_waiting_(queue), serve_(std::move(serve)) {}

bool Lane::enter(Arrival& arrival) {
    const std::lock_guard lock(mutex_);
    if (closed_) return false;
    if (waiting_.size() >= idle_ && threads_.size() < most_threads_) {
        try {
            threads_.emplace_back([this] { run(); });
            ++idle_;                          // it will look for work before it rests
        } catch (const std::system_error&) {  // no more threads: those that are there do the work
            if (threads_.empty()) return false;
        }
    }
    if (waiting_.size() >= idle_ + most_waiting_) return false;
    waiting_.push_back(std::move(arrival));
    wake_.notify_one();
    return true;
}

void Lane::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    wake_.notify_all();
    threads_.clear();  // joins
}

void Lane::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [&] { return !waiting_.empty() || closed_; });
        if (waiting_.empty()) return;
        Arrival arrival = std::move(waiting_.front());
        waiting_.pop_front();
        --idle_;
        lock.unlock();
        serve_(std::move(arrival));
        lock.lock();
        ++idle_;
    }
}

}  // namespace lpf::http
