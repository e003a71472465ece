#include "server/jobs/queue_forecast.h"

#include <algorithm>

namespace lpf::server {
namespace {

constexpr auto kFresh = std::chrono::seconds(1);  // other servers may work on the same queue
constexpr double kMemory = 0.9;                   // weight of what was known, with each new job
constexpr double kOverhead = 2000;                // of any job [points' worth of time]
constexpr std::size_t kPastJobs = 50;

double work_of(std::uint64_t points) { return static_cast<double>(points) + kOverhead; }

}  // namespace

QueueForecast::QueueForecast(const JobStore& store, const RunningJobs& running, int workers)
    : store_(store), running_(running), workers_(workers) {}

void QueueForecast::learn_from_store() {
    std::vector<PastJob> jobs = store_.past_jobs(kPastJobs);
    std::ranges::reverse(jobs);
    for (const PastJob& job : jobs) learn(job);
}

void QueueForecast::learn(const PastJob& job) {
    const std::lock_guard lock(mutex_);
    Speed& speed = speeds_[job.process];
    speed.seconds = kMemory * speed.seconds + job.seconds;
    speed.work = kMemory * speed.work + work_of(job.points);
}

void QueueForecast::outdated() {
    const std::lock_guard lock(mutex_);
    refreshed_.reset();
}

void QueueForecast::tell(StatusInfo& info) {
    const std::lock_guard lock(mutex_);
    if (!refreshed_ || Clock::now() - *refreshed_ > kFresh) refresh();
    const auto place = places_.find(info.job_id);
    if (place == places_.end()) return;
    info.queue_position = place->second.position;
    info.estimated_start = place->second.start;
}

std::optional<double> QueueForecast::seconds_for(Task process, std::uint64_t points) const {
    const auto speed = speeds_.find(process);
    if (speed == speeds_.end()) return std::nullopt;
    return work_of(points) * speed->second.seconds / speed->second.work;
}

std::vector<double> QueueForecast::busy_seconds() const {
    std::vector<double> busy;
    for (const auto& job : running_.all()) {
        const StatusInfo info = job->info();
        const double expected = seconds_for(info.process, job->points()).value_or(0);
        busy.push_back(info.eta_seconds.value_or(std::max(0.0, expected - job->seconds())));
    }
    busy.resize(static_cast<std::size_t>(workers_), 0.0);
    return busy;
}

void QueueForecast::refresh() {
    const UnixMillis now = now_millis();
    places_.clear();
    const std::vector<WaitingJob> jobs = store_.waiting();
    std::vector<double> seconds;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        places_[jobs[i].id].position = i + 1;
        if (seconds.size() < i) continue;  // how long one before it takes is not known
        if (const auto time = seconds_for(jobs[i].process, jobs[i].points))
            seconds.push_back(*time);
    }
    const std::vector<double> starts = start_times(busy_seconds(), seconds);
    for (std::size_t i = 0; i < starts.size(); ++i)
        places_[jobs[i].id].start = now + static_cast<UnixMillis>(starts[i] * 1000);
    refreshed_ = Clock::now();
}

}  // namespace lpf::server
