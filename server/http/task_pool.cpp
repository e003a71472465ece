#include "server/http/task_pool.h"

namespace lpf::http {
namespace {

thread_local bool refusing_here = false;

}  // namespace

TaskPool::TaskPool(std::size_t threads, std::size_t queue) : capacity_(queue) {
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { run(); });
}

bool TaskPool::refusing() { return refusing_here; }

void TaskPool::enqueue(std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        if (tasks_.size() < capacity_) {
            tasks_.push_back(std::move(task));
            wake_.notify_one();
            return;
        }
    }
    refusing_here = true;
    task();
    refusing_here = false;
}

void TaskPool::shutdown() {
    {
        const std::lock_guard lock(mutex_);
        leaving_ = true;
    }
    wake_.notify_all();
    threads_.clear();  // joins
}

void TaskPool::run() {
    for (;;) {
        std::function<void()> task;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [&] { return !tasks_.empty() || leaving_; });
            if (tasks_.empty()) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
    }
}

}  // namespace lpf::http
