// The part of JobQueue that the workers run: from the claim of a job to its end in the store.
#include <algorithm>

#include "api/memory_need.h"
#include "api/parameters.h"
#include "core/base/memory.h"
#include "server/job_queue.h"
#include "server/jobs/job_endings.h"

namespace lpf::server {
namespace {

constexpr auto kPoll = std::chrono::seconds(1);   // other servers may add to the queue
constexpr auto kRetry = std::chrono::seconds(1);  // of an end that could not be stored

}  // namespace

void JobQueue::work_until_stopped() {
    while (!stopping_) {
        std::uint64_t seen = 0;
        {
            const std::lock_guard lock(mutex_);
            seen = arrivals_;
        }
        try {
            if (const auto job = claim()) {
                run(*job);
                continue;
            }
        } catch (const std::exception& error) {
            log_.error("claim-failed", {{"error", error.what()}});
        }
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, kPoll, [&] { return stopping_ || arrivals_ != seen; });
    }
}

/// Memory that no running job may take. A job that is alone always starts: if it was accepted under
/// a larger budget it is refused then, and does not wait for ever.
std::optional<std::uint64_t> JobQueue::memory_free() const {
    if (options_.memory == 0 || running_.all().empty()) return std::nullopt;
    const std::uint64_t taken = running_.memory();
    return options_.memory - std::min(taken, options_.memory);
}

RunningJobs::Pointer JobQueue::claim() {
    const std::lock_guard lock(claim_mutex_);
    // One worker, if there are several, is kept for small jobs.
    const std::size_t large = running_.count_larger_than(options_.small_points);
    const auto workers = static_cast<std::size_t>(options_.workers);
    const UnixMillis now = now_millis();
    auto claim =
        storage_.jobs().claim_next({.now = now,
                                    .lease_until = leases_.until(now),
                                    .rules = {.small_only = workers > 1 && large + 1 >= workers,
                                              .small_points = options_.small_points,
                                              .running_per_owner = options_.running_per_owner,
                                              .memory_free = memory_free(),
                                              .now = now}});
    if (!claim) return nullptr;
    const double asked = claim->info.parameters.max_seconds.value_or(options_.job_seconds);
    auto job =
        std::make_shared<RunningJob>(std::move(*claim), std::min(asked, options_.job_seconds));
    running_.add(job);
    return job;
}

void JobQueue::run(RunningJob& job) {
    const std::string& id = job.lease().job_id;
    forecast_.outdated();
    if (stopping_) job.stop(StopReason::Shutdown);
    const StatusInfo begun = job.info();
    teller_.runs(begun);
    if (begun.attempt == 1)
        telemetry_.observe_queue_wait(
            static_cast<double>(begun.started.value_or(begun.created) - begun.created) / 1000.0);
    log_.info("job-started", {{"job", id}, {"attempt", begun.attempt}});
    try {
        run_guarded(job);
    } catch (const std::exception& error) {  // the lease runs out, and the job is taken back
        log_.error("job-not-stored", {{"job", id}, {"error", error.what()}});
    }
    running_.remove(job);
    return_freed_memory();
    tell_waiters();
    queue_grew();  // jobs may have waited for the memory
}

void JobQueue::run_guarded(RunningJob& job) {
    std::exception_ptr exception;
    try {
        if (options_.memory > 0) require_memory(static_cast<double>(job.memory()), options_.memory);
        const JobOutcome outcome = work_(job);
        if (!job.stop_reason()) {
            finish(job, succeeded(job.info(), now_millis(), options_.result_retention), outcome);
            return;
        }
    } catch (...) {
        exception = std::current_exception();
    }
    if (job.stop_reason()) {
        end_stopped(job);
        return;
    }
    Problem problem = problem_of(exception);
    log_.warn("job-failed", {{"job", job.lease().job_id},
                             {"code", std::string(problem.code())},
                             {"error", what_of(exception)}});
    finish(job, failed(job.info(), std::move(problem), now_millis(), options_.result_retention),
           {});
}

void JobQueue::end_stopped(RunningJob& job) {
    const std::string& id = job.lease().job_id;
    switch (*job.stop_reason()) {
        case StopReason::Dismissed:
            telemetry_.observe_cancel(job.seconds_stopping());
            log_.info("job-dismissed", {{"job", id}});
            return;
        case StopReason::Shutdown:
            if (!storage_.jobs().give_back(job.lease(), now_millis())) return;
            if (const auto waiting = storage_.jobs().find_job(id)) teller_.waits(waiting->info);
            log_.info("job-given-back", {{"job", id}});
            return;
        case StopReason::TimedOut:
            finish(job, failed(job.info(), out_of_time(), now_millis(), options_.result_retention),
                   {});
            return;
        case StopReason::LeaseLost: return;  // whoever took it away has told of it
    }
}

void JobQueue::finish(RunningJob& job, const StatusInfo& info, const JobOutcome& outcome) {
    job.begin_end();
    if (!store_end(job, info, outcome)) {
        leases_.lost(job);
        return;
    }
    teller_.ends(info);
    const std::string status(status_name(info.status));
    telemetry_.count_job(process_id(info.process), status, job.seconds());
    for (const auto& [phase, seconds] : outcome.phase_seconds)
        telemetry_.observe_phase(phase, seconds);
    if (info.status == JobStatus::Successful)
        forecast_.learn({info.process, job.points(), job.seconds()});
    log_.info("job-finished",
              {{"job", info.job_id}, {"status", status}, {"seconds", job.seconds()}});
}

/// Work that is done is not thrown away because the disk is full for a moment: tries again for as
/// long as the job is still this worker's.
bool JobQueue::store_end(RunningJob& job, const StatusInfo& info, const JobOutcome& outcome) {
    auto dictionary = outcome.dictionary;
    if (dictionary) dictionary->expires = info.expires.value_or(0);
    for (;;) {
        try {
            return storage_.jobs().finish(job.lease(), info, outcome.results, dictionary,
                                          now_millis());
        } catch (const std::exception& error) {
            log_.error("end-not-stored", {{"job", info.job_id}, {"error", error.what()}});
        }
        const auto reason = job.stop_reason();
        if (reason == StopReason::LeaseLost || reason == StopReason::Dismissed) return false;
        std::unique_lock lock(mutex_);
        if (wake_.wait_for(lock, kRetry, [&] { return stopping_.load(); })) return false;
    }
}

}  // namespace lpf::server
