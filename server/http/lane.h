#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/http/connection.h"

namespace lpf::http {

/// Threads for one kind of requests, started as they are needed, with a bounded queue: a rush of
/// one kind does not hold up the others.
class Lane {
public:
    Lane(std::size_t threads, std::size_t queue, std::function<void(Arrival)> serve);
    ~Lane() { close(); }
    Lane(const Lane&) = delete;
    Lane& operator=(const Lane&) = delete;

    /// @returns false, and leaves the arrival alone, if the lane is full
    bool enter(Arrival& arrival);

    /// Serves what has entered, and ends the threads.
    void close();

private:
    void run();

    std::size_t most_threads_;
    std::size_t most_waiting_;
    std::function<void(Arrival)> serve_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<Arrival> waiting_;
    std::size_t idle_ = 0;
    bool closed_ = false;
    std::vector<std::jthread> threads_;
};

}  // namespace lpf::http
