#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/jobs/running_job.h"

namespace lpf::server {

/// The jobs that the workers of this process have. Any number of threads may call.
class RunningJobs {
public:
    using Pointer = std::shared_ptr<RunningJob>;

    void add(const Pointer& job);
    void remove(const RunningJob& job);

    [[nodiscard]] std::vector<Pointer> all() const;
    /// The one with this ID, or null. A job whose lease was lost may be here twice, for a moment:
    /// then it is the later one.
    [[nodiscard]] Pointer find(const std::string& job_id) const;
    [[nodiscard]] std::size_t count_larger_than(std::uint64_t points) const;
    /// That all of them together may take [bytes].
    [[nodiscard]] std::uint64_t memory() const;

private:
    mutable std::mutex mutex_;
    std::map<std::string, Pointer> jobs_;  // by token: tokens sort by time
};

}  // namespace lpf::server
