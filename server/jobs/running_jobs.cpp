#include "server/jobs/running_jobs.h"

#include <algorithm>

namespace lpf::server {

void RunningJobs::add(const Pointer& job) {
    const std::lock_guard lock(mutex_);
    jobs_[job->lease().token] = job;
}

void RunningJobs::remove(const RunningJob& job) {
    const std::lock_guard lock(mutex_);
    jobs_.erase(job.lease().token);
}

std::vector<RunningJobs::Pointer> RunningJobs::all() const {
    const std::lock_guard lock(mutex_);
    std::vector<Pointer> jobs;
    for (const auto& [token, job] : jobs_) jobs.push_back(job);
    return jobs;
}

RunningJobs::Pointer RunningJobs::find(const std::string& job_id) const {
    const std::lock_guard lock(mutex_);
    Pointer found;
    for (const auto& [token, job] : jobs_)
        if (job->lease().job_id == job_id) found = job;
    return found;
}

std::size_t RunningJobs::count_larger_than(std::uint64_t points) const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(
        jobs_, [&](const auto& entry) { return entry.second->points() > points; }));
}

std::uint64_t RunningJobs::memory() const {
    const std::lock_guard lock(mutex_);
    std::uint64_t sum = 0;
    for (const auto& [token, job] : jobs_) sum += job->memory();
    return sum;
}

}  // namespace lpf::server
