#pragma once

#include <map>
#include <mutex>
#include <string>

#include "server/jobs/job_events.h"

namespace lpf::server {

/// Makes events of what happens to jobs: finds out what is new. Any number of threads may call.
class JobTeller {
public:
    explicit JobTeller(JobEvents& events) : events_(events) {}

    /// A job waits, for the first time or again.
    void waits(const StatusInfo& info);
    void waits_first(const StatusInfo& info);
    /// A job runs; a job that this process has not told of before has waited until now.
    void runs(const StatusInfo& info);
    /// A running job may have come further.
    void moves(const StatusInfo& info, bool with_progress);
    /// A job has ended, in whatever way.
    void ends(const StatusInfo& info);

private:
    struct Told {
        std::string phase;
        std::size_t warnings = 0;
    };
    void tell_news(Told& told, const StatusInfo& info);

    JobEvents& events_;
    std::mutex mutex_;
    std::map<std::string, Told> told_;  // of jobs that run
};

}  // namespace lpf::server
