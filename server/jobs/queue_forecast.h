#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/job_store.h"
#include "server/jobs/running_jobs.h"

namespace lpf::server {

/// Where waiting jobs stand and when they will start, by the speed of the jobs before. Any number
/// of threads may call.
class QueueForecast {
public:
    QueueForecast(const JobStore& store, const RunningJobs& running, int workers);

    /// Learns from the jobs of the past. @throws Error{StorageFailure}
    void learn_from_store();
    void learn(const PastJob& job);

    /// Fills in queuePosition and estimatedStart of a job that waits.
    void tell(StatusInfo& info);

    /// The queue has changed.
    void outdated();

private:
    struct Place {
        std::uint64_t position = 0;
        std::optional<UnixMillis> start;
    };
    /// Of one process: a sum over the jobs, older ones counting less and less.
    struct Speed {
        double seconds = 0;
        double work = 0;
    };
    void refresh();
    [[nodiscard]] std::optional<double> seconds_for(Task process, std::uint64_t points) const;
    [[nodiscard]] std::vector<double> busy_seconds() const;

    const JobStore& store_;
    const RunningJobs& running_;
    int workers_;
    std::mutex mutex_;
    std::map<Task, Speed> speeds_;
    std::map<std::string, Place> places_;
    std::optional<Clock::time_point> refreshed_;
};

}  // namespace lpf::server
