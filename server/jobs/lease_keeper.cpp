#include "server/jobs/lease_keeper.h"

#include "server/clock.h"

namespace lpf::server {

LeaseKeeper::LeaseKeeper(JobStore& store, RunningJobs& running, Log& log, Telemetry& telemetry,
                         LeaseOptions options, TakenBack taken_back)
    : store_(store),
      running_(running),
      log_(log),
      telemetry_(telemetry),
      options_(options),
      taken_back_(std::move(taken_back)) {}

void LeaseKeeper::start() {
    renewer_ = std::jthread([this](const std::stop_token& stop) {
        every(options_.lease / 3, stop, [this] { renew(); });
    });
    sweeper_ = std::jthread(
        [this](const std::stop_token& stop) { every(options_.sweep, stop, [this] { sweep(); }); });
}

void LeaseKeeper::stop() {
    sweeper_ = {};  // asks it to stop, and joins
    renewer_ = {};
}

void LeaseKeeper::every(std::chrono::milliseconds time, const std::stop_token& stop,
                        const std::function<void()>& action) {
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait_for(lock, stop, time, [] { return false; });
        if (stop.stop_requested()) return;
        lock.unlock();
        try {
            action();
        } catch (const std::exception& error) {
            log_.error("leases-not-kept", {{"error", error.what()}});
        }
        lock.lock();
    }
}

void LeaseKeeper::renew() {
    for (const auto& job : running_.all()) renew(*job);
}

void LeaseKeeper::renew(RunningJob& job) {
    const UnixMillis now = now_millis();
    try {
        if (store_.extend(job.lease(), now, until(now))) {
            job.lease_holds_until(until(now));
            return;
        }
    } catch (const std::exception& error) {
        log_.error("lease-not-renewed", {{"job", job.lease().job_id}, {"error", error.what()}});
        if (now < job.lease_until()) return;  // there is time for another try
    }
    if (!job.stop_reason() && !job.is_ending()) lost(job);
}

void LeaseKeeper::lost(RunningJob& job) {
    const auto stored = store_.find_job(job.lease().job_id);
    if (stored && stored->info.status == JobStatus::Dismissed) {
        job.stop(StopReason::Dismissed);
        return;
    }
    if (!job.stop(StopReason::LeaseLost)) return;  // dismissed, or known already
    telemetry_.count_lease_loss();
    log_.warn("lease-lost", {{"job", job.lease().job_id}});
}

void LeaseKeeper::sweep() {
    const auto jobs = store_.take_back_expired(options_.max_attempts, now_millis());
    if (jobs.empty()) return;
    log_.warn("leases-expired", {{"jobs", static_cast<std::int64_t>(jobs.size())}});
    taken_back_(jobs);
}

}  // namespace lpf::server
