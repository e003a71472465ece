#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "api/job.h"
#include "api/results.h"
#include "api/shape_info.h"

namespace lpf::server {

/// The right to work on a job: every write of a worker shows it, and is refused once the job has
/// been taken away (dismissed, or given to another worker).
struct Lease {
    std::string job_id;
    std::string token;
};

/// A job with what the client is not told.
struct StoredJob {
    StatusInfo info;
    std::vector<ResultFile> results;
    bool results_expired = false;  ///< they were there, and their time has run out
};

struct ClaimedJob {
    StatusInfo info;
    Lease lease;
};

struct JobFilter {
    std::optional<JobStatus> status;  ///< without one, dismissed jobs are left out
    std::optional<Task> process;
    std::size_t limit = 20;
    std::string cursor;  ///< of the page before, or empty
};

struct JobPage {
    std::vector<StatusInfo> jobs;  ///< newest first
    std::string next_cursor;       ///< empty on the last page
};

/// A dictionary that a job has learned; its bytes are the blob `sha256`.
struct StoredDictionary {
    std::string id;
    std::string job_id;
    std::string sha256;
    UnixMillis created = 0;
    UnixMillis expires = 0;
    std::string summary;  ///< JSON text, as the list shows it
};

struct DictionaryPage {
    std::vector<StoredDictionary> dictionaries;  ///< newest first
    std::string next_cursor;
};

struct QueueFigures {
    std::map<JobStatus, std::uint64_t> jobs;
    std::optional<UnixMillis> oldest_accepted;
};

/// The books: shapes, jobs, results and dictionaries. Every change is durable when the call
/// returns. Any number of threads may call. All functions throw Error{StorageFailure}.
class JobStore {
public:
    virtual ~JobStore() = default;

    /// Adds a shape; if one with the same bytes is here already, that one lives on instead, as long
    /// as the new one would have.
    /// @returns the one that is here now
    virtual ShapeInfo add_shape(const ShapeInfo& shape) = 0;
    [[nodiscard]] virtual std::optional<ShapeInfo> find_shape(const std::string& id) const = 0;
    [[nodiscard]] virtual std::optional<ShapeInfo> find_shape_by_digest(
        const std::string& sha256) const = 0;
    /// Lets a shape live at least until then. @returns the shape as it is now, or nothing
    virtual std::optional<ShapeInfo> keep_shape_until(const std::string& id,
                                                      UnixMillis expires) = 0;
    /// @throws ProblemException{ShapeInUse} while an unfinished job needs it
    /// @returns false if there is none
    virtual bool remove_shape(const std::string& id) = 0;

    /// @throws ProblemException{QueueFull} if `max_waiting` jobs wait already, and
    ///         {ShapeNotFound} if its shape was removed meanwhile
    virtual void add_job(const StatusInfo& job, std::uint64_t max_waiting) = 0;
    [[nodiscard]] virtual std::optional<StoredJob> find_job(const std::string& id) const = 0;
    [[nodiscard]] virtual JobPage list_jobs(const JobFilter& filter) const = 0;
    [[nodiscard]] virtual QueueFigures figures() const = 0;

    /// Takes the job that waits longest: it runs from now on, under the lease.
    virtual std::optional<ClaimedJob> claim_next(UnixMillis now) = 0;
    /// @returns false if the lease is void: stop working
    virtual bool save_progress(const Lease& lease, const StatusInfo& info) = 0;
    /// Ends the job, its results and its dictionary becoming visible together with the status.
    /// @returns false if the lease is void: nothing was changed
    virtual bool finish(const Lease& lease, const StatusInfo& info,
                        const std::vector<ResultFile>& results,
                        const std::optional<StoredDictionary>& dictionary) = 0;
    /// Back to waiting, at its old place; the attempt does not count.
    virtual bool give_back(const Lease& lease, UnixMillis now) = 0;

    /// Ends the job for good and lets go of its results. Voids its lease.
    /// @returns nothing if there is no such job, or it was dismissed before
    virtual std::optional<StatusInfo> dismiss(const std::string& id, UnixMillis now) = 0;

    /// After a crash: jobs that were running wait again, or fail with `worker-lost` if they have
    /// had their attempts. Call before the first claim, with no other server on the same store.
    /// @returns number of jobs that were running
    virtual std::size_t recover(std::uint64_t max_attempts, UnixMillis now) = 0;

    [[nodiscard]] virtual std::optional<StoredDictionary> find_dictionary(
        const std::string& id) const = 0;
    [[nodiscard]] virtual DictionaryPage list_dictionaries(std::size_t limit,
                                                           const std::string& cursor) const = 0;

    /// Removes what has expired: results and dictionaries, shapes that no unfinished job needs, and
    /// jobs that finished longer than `status_retention` milliseconds ago.
    /// @returns number of records removed
    virtual std::size_t remove_expired(UnixMillis now, UnixMillis status_retention) = 0;

    /// True if a shape, a result or a dictionary has these bytes.
    [[nodiscard]] virtual bool refers_to(const std::string& sha256) const = 0;

    /// Everything known, for a sweep over the blobs.
    [[nodiscard]] virtual std::set<std::string> all_digests() const = 0;
};

}  // namespace lpf::server
