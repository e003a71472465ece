#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/error.h"

namespace lpf {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kReportInterval = std::chrono::milliseconds(50);

/// Counts finished items of all threads and passes a report on now and then.
class Reporter {
public:
    Reporter(const Execution& execution, std::string_view phase, std::string_view unit,
             std::size_t total)
        : sink_(execution.progress), phase_(phase), unit_(unit), total_(total) {
        report();
    }

    void finished(std::size_t items) {
        if (!sink_) return;
        const std::scoped_lock lock(mutex_);
        done_ += items;
        if (done_ == total_ || Clock::now() - last_ >= kReportInterval) report();
    }

private:
    void report() {
        if (!sink_) return;
        last_ = Clock::now();
        const double fraction =
            total_ ? static_cast<double>(done_) / static_cast<double>(total_) : 1;
        sink_({phase_, done_, total_, unit_, fraction});
    }

    const ProgressSink& sink_;
    std::string_view phase_;
    std::string_view unit_;
    std::size_t total_;
    std::size_t done_ = 0;
    Clock::time_point last_{};
    std::mutex mutex_;
};

}  // namespace

void throw_if_cancelled(const Execution& execution) {
    if (execution.stop.stop_requested())
        throw Error(ErrorCode::Cancelled, "The job was cancelled.");
}

void parallel_for(const Execution& execution, std::size_t n, std::size_t chunk_size,
                  const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
    const std::size_t chunks = chunk_count(n, chunk_size);
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;

    const auto work = [&] {
        try {
            for (std::size_t chunk = next++; chunk < chunks; chunk = next++) {
                throw_if_cancelled(execution);
                const std::size_t begin = chunk * chunk_size;
                body(begin, std::min(n, begin + chunk_size), chunk);
            }
        } catch (...) {
            next = chunks;
            const std::scoped_lock lock(failure_mutex);
            if (!failure) failure = std::current_exception();
        }
    };

    {
        const auto wanted = static_cast<std::size_t>(std::max(1, execution.threads));
        std::vector<std::jthread> helpers;
        for (std::size_t i = 1; i < std::min(wanted, chunks); ++i) helpers.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

void parallel_for(const Execution& execution, std::string_view phase, std::string_view unit,
                  std::size_t n, std::size_t chunk_size,
                  const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
    Reporter reporter(execution, phase, unit, n);
    parallel_for(execution, n, chunk_size,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     body(begin, end, chunk);
                     reporter.finished(end - begin);
                 });
}

void report_done(const Execution& execution, std::string_view phase, std::string_view unit) {
    if (execution.progress) execution.progress({.phase = phase, .unit = unit, .fraction = 1.0});
}

Execution on_one_thread(const Execution& execution) {
    Execution sequential = execution;
    sequential.threads = 1;
    return sequential;
}

Execution step_of(const Execution& execution, std::size_t step, std::size_t steps) {
    const auto all = static_cast<double>(steps);
    return part_of(execution, static_cast<double>(step) / all, static_cast<double>(step + 1) / all);
}

Execution part_of(const Execution& execution, double low, double high) {
    Execution part = execution;
    if (execution.progress) {
        part.progress = [sink = execution.progress, low, high](Progress progress) {
            // Exact at both ends: what ends here never lies above what begins there.
            progress.fraction = std::lerp(low, high, progress.fraction);
            sink(progress);
        };
    }
    return part;
}

}  // namespace lpf
