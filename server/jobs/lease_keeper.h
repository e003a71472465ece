#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "server/job_store.h"
#include "server/jobs/running_jobs.h"
#include "server/log.h"
#include "server/telemetry.h"

namespace lpf::server {

struct LeaseOptions {
    std::chrono::milliseconds lease{30'000};  ///< renewed every third of it
    std::chrono::milliseconds sweep{5'000};   ///< between two looks for leases that ran out
    std::uint64_t max_attempts = 3;
};

/// Renews the leases of the jobs that run here, and takes jobs back whose lease ran out, whoever
/// had it.
class LeaseKeeper {
public:
    /// @param taken_back is told of jobs that were taken back, as they are now
    using TakenBack = std::function<void(const std::vector<StatusInfo>&)>;

    LeaseKeeper(JobStore& store, RunningJobs& running, Log& log, Telemetry& telemetry,
                LeaseOptions options, TakenBack taken_back);

    void start();
    /// Call when nothing runs any more.
    void stop();

    [[nodiscard]] UnixMillis until(UnixMillis now) const { return now + options_.lease.count(); }
    /// A write of a worker was refused: its lease had run out.
    void lost(RunningJob& job);

private:
    void every(std::chrono::milliseconds time, const std::stop_token& stop,
               const std::function<void()>& action);
    void renew();
    void renew(RunningJob& job);
    void sweep();

    JobStore& store_;
    RunningJobs& running_;
    Log& log_;
    Telemetry& telemetry_;
    LeaseOptions options_;
    TakenBack taken_back_;
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::jthread renewer_;
    std::jthread sweeper_;
};

}  // namespace lpf::server
