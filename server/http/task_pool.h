#pragma once

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lpf::http {

/// A thread pool with a bounded queue. A task that finds the queue full runs at once on the
/// accepting thread, with refusing() true, and has to be short: it says 503 and leaves.
class TaskPool : public httplib::TaskQueue {
public:
    TaskPool(std::size_t threads, std::size_t queue);

    void enqueue(std::function<void()> task) override;
    void shutdown() override;

    /// True on a thread that runs a task for which there was no room.
    [[nodiscard]] static bool refusing();

private:
    void run();

    std::size_t capacity_;
    std::mutex mutex_;
    std::condition_variable wake_;
    std::deque<std::function<void()>> tasks_;
    bool leaving_ = false;
    std::vector<std::jthread> threads_;
};

}  // namespace lpf::http
