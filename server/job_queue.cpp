#include "server/job_queue.h"

#include <algorithm>

#include "api/problem.h"

namespace lpf::server {
namespace {

constexpr auto kTick = std::chrono::milliseconds(200);
constexpr int kTicksPerSave = 5;  // progress is told and written once a second

}  // namespace

JobQueue::JobQueue(Storage& storage, JobEvents& events, Log& log, Telemetry& telemetry,
                   QueueOptions options, JobWork work)
    : storage_(storage),
      log_(log),
      telemetry_(telemetry),
      options_(options),
      work_(std::move(work)),
      forecast_(storage.jobs(), running_, options.workers),
      teller_(events),
      leases_(storage.jobs(), running_, log, telemetry, options.leases,
              [this](const std::vector<StatusInfo>& jobs) {
                  for (const StatusInfo& job : jobs)
                      is_finished(job.status) ? teller_.ends(job) : teller_.waits(job);
                  queue_grew();
                  tell_waiters();
              }) {}

JobQueue::~JobQueue() { stop(); }

void JobQueue::start() {
    const auto lost = storage_.jobs().take_back_all(options_.leases.max_attempts, now_millis());
    if (!lost.empty())
        log_.warn("jobs-recovered", {{"jobs", static_cast<std::int64_t>(lost.size())}});
    forecast_.learn_from_store();
    leases_.start();
    for (int i = 0; i < options_.workers; ++i)
        workers_.emplace_back([this] { work_until_stopped(); });
    watcher_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void JobQueue::refuse_new() {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    wake_.notify_all();
    ended_.notify_all();
}

void JobQueue::stop() {
    refuse_new();
    for (const auto& job : running_.all()) job->stop(StopReason::Shutdown);
    workers_.clear();  // joins
    watcher_ = {};
    leases_.stop();
}

void JobQueue::submit(const NewJob& job) {
    if (stopping_) {
        throw ProblemException({.problem = ProblemCode::Unavailable,
                                .detail = "The server is about to stop; try again in a minute.",
                                .retry_after = 60});
    }
    storage_.jobs().add_job(job, options_.limits);
    teller_.waits_first(job.info);
    queue_grew();
}

void JobQueue::queue_grew() {
    forecast_.outdated();
    const std::lock_guard lock(mutex_);
    ++arrivals_;
    wake_.notify_all();  // not every worker may take every job
}

void JobQueue::freshen(StatusInfo& info) {
    if (info.status == JobStatus::Accepted) forecast_.tell(info);
    if (info.status != JobStatus::Running) return;
    if (const auto live = running_.find(info.job_id)) {
        std::vector<std::string> retries = std::move(info.retries);
        info = live->info();
        info.retries = std::move(retries);
    }
}

std::optional<StoredJob> JobQueue::find(const std::string& id) {
    auto job = storage_.jobs().find_job(id);
    if (job) freshen(job->info);
    return job;
}

JobPage JobQueue::list(const JobFilter& filter) {
    JobPage page = storage_.jobs().list_jobs(filter);
    for (StatusInfo& info : page.jobs) freshen(info);
    return page;
}

std::optional<StatusInfo> JobQueue::dismiss(const std::string& id) {
    auto info = storage_.jobs().dismiss(id, now_millis());
    if (const auto job = running_.find(id)) job->stop(StopReason::Dismissed);
    if (info) teller_.ends(*info);
    forecast_.outdated();
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
    gauges.running = running_.all().size();
    gauges.workers = static_cast<std::uint64_t>(options_.workers);
    if (figures.oldest_accepted)
        gauges.oldest_queued_seconds =
            static_cast<double>(now_millis() - *figures.oldest_accepted) / 1000.0;
    gauges.uptime_seconds = seconds_since(started_);
    gauges.ready = accepting();
    return gauges;
}

void JobQueue::tell_waiters() {
    const std::lock_guard lock(mutex_);
    ++ends_;
    ended_.notify_all();
}

void JobQueue::watch(const std::stop_token& stop) {
    for (int tick = 1; !stop.stop_requested(); ++tick) {
        std::this_thread::sleep_for(kTick);
        const bool save = tick % kTicksPerSave == 0;
        for (const auto& job : running_.all()) {
            if (job->is_overdue()) job->stop(StopReason::TimedOut);
            if (job->stop_reason()) continue;
            teller_.moves(job->info(), save);
            if (save) save_progress(*job);
        }
    }
}

void JobQueue::save_progress(RunningJob& job) {
    try {
        if (!storage_.jobs().save_progress(job.lease(), job.info(), now_millis()) &&
            !job.is_ending())
            leases_.lost(job);  // its work is of no use any more
    } catch (const std::exception& error) {
        log_.error("progress-not-stored", {{"error", error.what()}});
    }
}

}  // namespace lpf::server
