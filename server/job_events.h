#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "api/job.h"

namespace lpf::server {

/// One line of the story of a job, as GET /v1/jobs/{id}/events tells it.
struct JobEvent {
    std::uint64_t id = 0;  ///< grows, also over a restart of the server
    std::string name;      ///< status, progress, log or end
    std::string data;      ///< JSON text, one line
};

/// The latest events of each job that is at work or ended not long ago, so that a client that was
/// cut off can go on where it was. Any number of threads may call.
class JobEvents {
public:
    /// A job has a new status; for one that has ended, `end` follows.
    void status(const StatusInfo& info);
    /// A job has come further (at least once a second while it runs).
    void progress(const StatusInfo& info);
    /// Something to know about a job: a warning, a phase.
    void log(const std::string& job_id, const std::string& code, const std::string& detail);

    /// Events of a job that are newer than `last`, oldest first; empty if there are none.
    [[nodiscard]] std::vector<JobEvent> after(const std::string& job_id, std::uint64_t last) const;

    /// Lets go of jobs that ended longer ago than a few minutes.
    void forget_old();

private:
    struct Story {
        std::deque<JobEvent> events;
        UnixMillis ended = 0;
    };
    void add(Story& story, std::string name, std::string data);

    mutable std::mutex mutex_;
    std::map<std::string, Story> stories_;
    std::uint64_t last_id_ = 0;
};

}  // namespace lpf::server
