#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/jobs/job_teller.h"
#include "server/jobs/lease_keeper.h"
#include "server/jobs/queue_forecast.h"
#include "server/jobs/running_jobs.h"
#include "server/log.h"
#include "server/store/storage.h"
#include "server/telemetry.h"

namespace lpf::server {

/// Does a job. Throws lpf::Error or ProblemException when it cannot be done.
using JobWork = std::function<JobOutcome(RunningJob&)>;

struct QueueOptions {
    int workers = 1;
    QueueLimits limits = {};
    std::uint64_t small_points = 100'000;  ///< jobs up to this size are small
    std::uint64_t running_per_owner = 0;   ///< 0: any number
    std::uint64_t memory = 0;              ///< of all running jobs [bytes]; 0: any amount
    LeaseOptions leases = {};
    double job_seconds = 3600;
    UnixMillis result_retention = 7LL * 24 * 3600 * 1000;
    int max_waiters = 8;  ///< requests that may wait for a job at a time
};

/// Runs the jobs of the store, a few at a time: small ones are not stuck behind large ones, and the
/// owners of jobs take turns (scheduling.h). The store is the truth; what is kept here is only the
/// fresher state of jobs that run right now.
class JobQueue {
public:
    JobQueue(Storage& storage, JobEvents& events, Log& log, Telemetry& telemetry,
             QueueOptions options, JobWork work);
    ~JobQueue();

    /// Takes up what an earlier run of the server left, and starts the workers.
    void start();

    /// Takes no new jobs from now on; requests that wait for one stop waiting.
    void refuse_new();

    /// Stops the workers and gives running jobs back, as if they had not been started.
    void stop();

    /// Makes a job durable and lets it run when its turn comes.
    /// @throws ProblemException{QueueFull, QuotaExceeded, IdempotencyConflict, Unavailable, ...}
    void submit(const NewJob& job);

    /// A job with the freshest state there is.
    [[nodiscard]] std::optional<StoredJob> find(const std::string& id);
    [[nodiscard]] JobPage list(const JobFilter& filter);

    /// Ends a job for good; one that runs stops within a second.
    /// @returns nothing if there is no such job, or it was dismissed before
    std::optional<StatusInfo> dismiss(const std::string& id);

    /// Waits until the job has ended or the time is up, unless too many wait already. Ends early
    /// when `abandoned` says so.
    /// @returns true if it has ended
    bool wait_for(const std::string& id, std::chrono::seconds time,
                  const std::function<bool()>& abandoned);

    [[nodiscard]] bool accepting() const { return !stopping_; }
    [[nodiscard]] Gauges gauges() const;
    [[nodiscard]] int workers() const { return options_.workers; }

private:
    void work_until_stopped();
    [[nodiscard]] RunningJobs::Pointer claim();
    [[nodiscard]] std::optional<std::uint64_t> memory_free() const;
    void run(RunningJob& job);
    void run_guarded(RunningJob& job);
    void end_stopped(RunningJob& job);
    void finish(RunningJob& job, const StatusInfo& info, const JobOutcome& outcome);
    [[nodiscard]] bool store_end(RunningJob& job, const StatusInfo& info,
                                 const JobOutcome& outcome);
    void watch(const std::stop_token& stop);
    void save_progress(RunningJob& job);
    void freshen(StatusInfo& info);
    void queue_grew();
    void tell_waiters();
    [[nodiscard]] bool has_ended(const std::string& id) const;

    Storage& storage_;
    Log& log_;
    Telemetry& telemetry_;
    QueueOptions options_;
    JobWork work_;
    Clock::time_point started_ = Clock::now();

    RunningJobs running_;
    QueueForecast forecast_;
    JobTeller teller_;
    LeaseKeeper leases_;

    std::mutex claim_mutex_;  // the choice of a job depends on what runs here
    mutable std::mutex mutex_;
    std::condition_variable wake_;   // a job may be waiting, or the end has come
    std::condition_variable ended_;  // a job has ended
    std::uint64_t ends_ = 0;         // jobs that have ended so far
    std::uint64_t arrivals_ = 0;
    std::atomic<int> waiters_ = 0;
    std::atomic<bool> stopping_ = false;
    std::vector<std::jthread> workers_;
    std::jthread watcher_;
};

}  // namespace lpf::server
