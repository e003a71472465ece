#include "server/job_queue.h"

#include <algorithm>

#include "api/parameters.h"
#include "core/base/error.h"

namespace lpf::server {
namespace {

constexpr auto kPoll = std::chrono::seconds(1);
constexpr auto kTick = std::chrono::milliseconds(200);
constexpr int kTicksPerSave = 5;  // progress is written once a second

/// What the client is told about an exception of the work.
Problem problem_of(const std::exception_ptr& exception) {
    try {
        std::rethrow_exception(exception);
    } catch (const ProblemException& error) {
        return error.problem();
    } catch (const Error& error) {
        return problem_from(error);
    } catch (const std::bad_alloc&) {
        return problem_from(Error(ErrorCode::OutOfMemory,
                                  "The job needs more memory than the server has. Ask for fewer "
                                  "points, or remove points from the shape."));
    } catch (...) {
        return problem_from(Error(ErrorCode::Internal, "The job failed."));
    }
}

/// The text for the log: also what the client is not told.
std::string what_of(const std::exception_ptr& exception) {
    try {
        std::rethrow_exception(exception);
    } catch (const std::exception& error) {
        return error.what();
    } catch (...) {
        return "an exception of unknown type";
    }
}

}  // namespace

JobQueue::JobQueue(Storage& storage, Log& log, Telemetry& telemetry, QueueOptions options,
                   JobWork work)
    : storage_(storage),
      log_(log),
      telemetry_(telemetry),
      options_(options),
      work_(std::move(work)) {}

JobQueue::~JobQueue() { stop(); }

void JobQueue::start() {
    const auto lost = storage_.jobs().recover(options_.max_attempts, now_millis());
    if (lost > 0) log_.warn("jobs-recovered", {{"jobs", static_cast<std::int64_t>(lost)}});
    for (int i = 0; i < options_.workers; ++i)
        threads_.emplace_back([this] { work_until_stopped(); });
    threads_.emplace_back([this] { watch(); });
}

void JobQueue::refuse_new() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    wake_.notify_all();
    ended_.notify_all();
}

void JobQueue::stop() {
    refuse_new();
    for (const auto& job : running()) job->stop(StopReason::Shutdown);
    threads_.clear();  // joins
}

void JobQueue::submit(const StatusInfo& job) {
    if (stopping_) {
        throw ProblemException({.problem = ProblemCode::Unavailable,
                                .detail = "The server is about to stop; try again in a minute.",
                                .retry_after = 60});
    }
    storage_.jobs().add_job(job, options_.max_waiting);
    const std::lock_guard lock(mutex_);
    ++arrivals_;
    wake_.notify_one();
}

std::optional<StoredJob> JobQueue::find(const std::string& id) const {
    std::shared_ptr<RunningJob> live;
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = running_.find(id); found != running_.end()) live = found->second;
    }
    auto job = storage_.jobs().find_job(id);
    if (job && live && job->info.status == JobStatus::Running) job->info = live->info();
    return job;
}

JobPage JobQueue::list(const JobFilter& filter) const {
    JobPage page = storage_.jobs().list_jobs(filter);
    const std::lock_guard lock(mutex_);
    for (StatusInfo& info : page.jobs) {
        const auto live = running_.find(info.job_id);
        if (live != running_.end() && info.status == JobStatus::Running)
            info = live->second->info();
    }
    return page;
}

std::optional<StatusInfo> JobQueue::dismiss(const std::string& id) {
    auto info = storage_.jobs().dismiss(id, now_millis());
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = running_.find(id); found != running_.end())
            found->second->stop(StopReason::Dismissed);
    }
    tell_waiters();
    return info;
}

bool JobQueue::has_ended(const std::string& id) const {
    const auto job = storage_.jobs().find_job(id);
    return !job || is_finished(job->info.status);
}

bool JobQueue::wait_for(const std::string& id, std::chrono::seconds time,
                        const std::function<bool()>& abandoned) {
    struct Seat {
        std::atomic<int>& taken;
        int number = ++taken;
        ~Seat() { --taken; }
    };
    const Seat seat{waiters_};
    const auto deadline = Clock::now() + time;
    for (;;) {
        std::unique_lock lock(mutex_);
        const std::uint64_t seen = ends_;
        lock.unlock();
        if (has_ended(id)) return true;
        if (seat.number > options_.max_waiters) return false;
        lock.lock();
        while (ends_ == seen) {
            if (stopping_ || Clock::now() >= deadline || (abandoned && abandoned())) return false;
            ended_.wait_until(lock, std::min(deadline, Clock::now() + kTick));
        }
    }
}

Gauges JobQueue::gauges() const {
    const QueueFigures figures = storage_.jobs().figures();
    Gauges gauges;
    gauges.jobs = figures.jobs;
    const auto waiting = figures.jobs.find(JobStatus::Accepted);
    gauges.queued = waiting == figures.jobs.end() ? 0 : waiting->second;
    gauges.running = running().size();
    gauges.workers = static_cast<std::uint64_t>(options_.workers);
    if (figures.oldest_accepted)
        gauges.oldest_queued_seconds =
            static_cast<double>(now_millis() - *figures.oldest_accepted) / 1000.0;
    gauges.uptime_seconds = seconds_since(started_);
    gauges.ready = accepting();
    return gauges;
}

std::vector<std::shared_ptr<RunningJob>> JobQueue::running() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<RunningJob>> jobs;
    for (const auto& [id, job] : running_) jobs.push_back(job);
    return jobs;
}

void JobQueue::tell_waiters() {
    const std::lock_guard lock(mutex_);
    ++ends_;
    ended_.notify_all();
}

void JobQueue::work_until_stopped() {
    while (!stopping_) {
        std::uint64_t seen = 0;
        {
            const std::lock_guard lock(mutex_);
            seen = arrivals_;
        }
        try {
            if (auto claim = storage_.jobs().claim_next(now_millis())) {
                run(std::move(*claim));
                continue;
            }
        } catch (const std::exception& error) {
            log_.error("claim-failed", {{"error", error.what()}});
        }
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, kPoll, [&] { return stopping_ || arrivals_ != seen; });
    }
}

void JobQueue::run(ClaimedJob claim) {
    const double seconds = claim.info.parameters.max_seconds.value_or(options_.job_seconds);
    const auto job =
        std::make_shared<RunningJob>(std::move(claim), std::min(seconds, options_.job_seconds));
    const std::string id = job->lease().job_id;
    {
        const std::lock_guard lock(mutex_);
        running_[id] = job;
    }
    if (stopping_) job->stop(StopReason::Shutdown);
    log_.info("job-started", {{"job", id}, {"attempt", job->info().attempt}});
    try {
        run_guarded(*job);
    } catch (
        const std::exception& error) {  // the store failed: the job is recovered at the next start
        log_.error("job-not-stored", {{"job", id}, {"error", error.what()}});
    }
    {
        const std::lock_guard lock(mutex_);
        running_.erase(id);
    }
    tell_waiters();
}

void JobQueue::run_guarded(RunningJob& job) {
    std::exception_ptr exception;
    try {
        const JobOutcome outcome = work_(job);
        if (!job.stop_reason()) {
            finish(job, job.info(), outcome);
            return;
        }
    } catch (...) {
        exception = std::current_exception();
    }
    if (job.stop_reason()) {
        end_stopped(job);
        return;
    }
    const Problem problem = problem_of(exception);
    log_.warn("job-failed", {{"job", job.lease().job_id},
                             {"code", std::string(problem.code())},
                             {"error", what_of(exception)}});
    fail(job, problem);
}

void JobQueue::end_stopped(RunningJob& job) {
    switch (*job.stop_reason()) {
        case StopReason::Dismissed:
            telemetry_.observe_cancel(job.seconds_stopping());
            log_.info("job-dismissed", {{"job", job.lease().job_id}});
            return;
        case StopReason::Shutdown:
            storage_.jobs().give_back(job.lease(), now_millis());
            log_.info("job-given-back", {{"job", job.lease().job_id}});
            return;
        case StopReason::TimedOut:
            fail(job, problem_from(Error(ErrorCode::TimedOut,
                                         "The job ran longer than it was allowed to (maxSeconds). "
                                         "Allow more, or ask for less: a larger spacing, fewer "
                                         "iterations.")));
            return;
    }
}

void JobQueue::fail(RunningJob& job, const Problem& problem) {
    StatusInfo info = job.info();
    info.exception = problem;
    info.exception->instance = "/v1/jobs/" + info.job_id;
    finish(job, info, {});
}

void JobQueue::finish(RunningJob& job, StatusInfo info, const JobOutcome& outcome) {
    const UnixMillis now = now_millis();
    const bool failed = info.exception.has_value();
    info.status = failed ? JobStatus::Failed : JobStatus::Successful;
    info.message = failed ? info.exception->detail : "Done.";
    info.finished = now;
    info.updated = now;
    info.expires = now + options_.result_retention;
    info.eta_seconds.reset();
    if (!failed) {
        info.progress = 100;
        info.phase = "done";
        info.phase_progress.reset();
    }
    auto dictionary = outcome.dictionary;
    if (dictionary) dictionary->expires = *info.expires;
    if (!storage_.jobs().finish(job.lease(), info, outcome.results, dictionary)) return;
    telemetry_.count_job(process_id(info.process), status_name(info.status), job.seconds());
    log_.info("job-finished", {{"job", info.job_id},
                               {"status", std::string(status_name(info.status))},
                               {"seconds", job.seconds()}});
}

void JobQueue::watch() {
    for (int tick = 1; !stopping_; ++tick) {
        std::this_thread::sleep_for(kTick);
        const auto jobs = running();
        for (const auto& job : jobs)
            if (job->is_overdue()) job->stop(StopReason::TimedOut);
        if (tick % kTicksPerSave == 0) store_progress(jobs);
    }
}

void JobQueue::store_progress(const std::vector<std::shared_ptr<RunningJob>>& jobs) {
    for (const auto& job : jobs) {
        try {
            // A void lease means that another hand has taken the job: its work is of no use any
            // more.
            if (!storage_.jobs().save_progress(job->lease(), job->info()))
                job->stop(StopReason::Dismissed);
        } catch (const std::exception& error) {
            log_.error("progress-not-stored", {{"error", error.what()}});
        }
    }
}

}  // namespace lpf::server
