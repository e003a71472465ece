#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
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
///
/// Memory is bounded: of each job the last progress alone and a few dozen of the other events are
/// kept, and of jobs that ended so many. What is not here any more, a reader finds in the books.
class JobEvents {
public:
    JobEvents();

    /// A job has a new status; for one that has ended, `end` follows.
    void status(const StatusInfo& info);
    /// A job has come further (at least once a second while it runs).
    void progress(const StatusInfo& info);
    /// Something to know about a job: a warning, a phase.
    void log(const std::string& job_id, const std::string& code, const std::string& detail);

    /// Events of a job that are newer than `last`, oldest first; empty if there are none. A `last`
    /// that was never given out hides nothing.
    [[nodiscard]] std::vector<JobEvent> after(const std::string& job_id, std::uint64_t last) const;

    /// True if anything is known of a job.
    [[nodiscard]] bool knows(const std::string& job_id) const;

    /// What one reader is told about a job of which nothing is known here: its status and, if it
    /// has ended, `end`. The ids are new, and nothing is kept.
    [[nodiscard]] std::vector<JobEvent> tell(const StatusInfo& info);

    /// Lets go of jobs that ended longer ago than a few minutes. Every change does so now and then.
    void forget_old();

private:
    struct Story {
        std::deque<JobEvent> events;
        UnixMillis ended = 0;
    };
    void add(Story& story, std::string name, std::string data);
    [[nodiscard]] std::uint64_t next_id();
    [[nodiscard]] Story& story_of(const std::string& job_id);
    void forget_before(UnixMillis time);
    void make_room();

    mutable std::mutex mutex_;
    std::map<std::string, Story> stories_;  // by job, and so by age: identifiers begin with a time
    std::uint64_t last_id_ = 0;
    UnixMillis cleaned_ = 0;
};

}  // namespace lpf::server
