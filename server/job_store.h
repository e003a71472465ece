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
#include "server/jobs/scheduling.h"

namespace lpf::server {

/// The right to work on a job, for a while: every write of a worker shows it, and is refused once
/// its time is over or the job has been taken away (dismissed, or given to another worker).
struct Lease {
    std::string job_id;
    std::string token;
};

/// What a client named its request by (Idempotency-Key), and what the request was.
struct RequestMark {
    std::string key;
    std::string fingerprint;  ///< digest of method, path, query and body
};

/// A job to be taken into the books, with what the client is not told.
struct NewJob {
    StatusInfo info;
    std::string owner = {};    ///< name of the API key that sent it, or empty
    std::uint64_t points = 0;  ///< of its shape
    std::uint64_t memory = 0;  ///< that it may take [bytes]
    std::optional<RequestMark> mark = {};
};

/// How many jobs may wait.
struct QueueLimits {
    std::uint64_t waiting = 1000;
    std::uint64_t waiting_per_owner = 100;  ///< no limit for the empty owner
};

/// A request that has made a job already.
struct MarkedRequest {
    std::string fingerprint;
    std::string job_id;
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
    std::uint64_t points = 0;  ///< of its shape
    std::uint64_t memory = 0;  ///< that it may take [bytes]
    UnixMillis lease_until = 0;
};

struct ClaimRequest {
    UnixMillis now = 0;
    UnixMillis lease_until = 0;
    TurnRules rules = {};
};

/// A job that was done, to learn from how long the next will take.
struct PastJob {
    Task process = Task::Denoise;
    std::uint64_t points = 0;
    double seconds = 0;
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
/// returns. Any number of threads may call. All functions throw Error{StorageFailure}, and those
/// that write ProblemException{InsufficientStorage} when there is no room.
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

    /// With a mark: no two jobs have the same mark of the same owner.
    /// @throws ProblemException{QueueFull, QuotaExceeded} if too many jobs wait already,
    ///         {ShapeNotFound} if its shape was removed meanwhile, {IdempotencyConflict} if there
    ///         is a job of this mark
    virtual void add_job(const NewJob& job, const QueueLimits& limits) = 0;
    /// The request of this owner that had this Idempotency-Key; for as long as its job is known.
    [[nodiscard]] virtual std::optional<MarkedRequest> find_request(
        const std::string& owner, const std::string& key) const = 0;
    [[nodiscard]] virtual std::optional<StoredJob> find_job(const std::string& id) const = 0;
    [[nodiscard]] virtual JobPage list_jobs(const JobFilter& filter) const = 0;
    [[nodiscard]] virtual QueueFigures figures() const = 0;
    /// The jobs that wait, in the order of their turns.
    [[nodiscard]] virtual std::vector<WaitingJob> waiting() const = 0;
    /// The latest jobs that were successful, newest first.
    [[nodiscard]] virtual std::vector<PastJob> past_jobs(std::size_t limit) const = 0;

    /// Takes the job whose turn it is (see scheduling.h): it runs from now on, under the lease.
    virtual std::optional<ClaimedJob> claim_next(const ClaimRequest& request) = 0;
    /// Makes a lease last until then. @returns false if it is void: stop working
    virtual bool extend(const Lease& lease, UnixMillis now, UnixMillis until) = 0;
    /// @returns false if the lease is void: stop working
    virtual bool save_progress(const Lease& lease, const StatusInfo& info, UnixMillis now) = 0;
    /// Ends the job, its results and its dictionary becoming visible together with the status.
    /// @returns false if the lease is void: nothing was changed
    virtual bool finish(const Lease& lease, const StatusInfo& info,
                        const std::vector<ResultFile>& results,
                        const std::optional<StoredDictionary>& dictionary, UnixMillis now) = 0;
    /// Back to waiting, at its old place; the attempt does not count.
    /// @returns false if the lease is void: nothing was changed
    virtual bool give_back(const Lease& lease, UnixMillis now) = 0;

    /// Ends the job for good and lets go of its results. Voids its lease.
    /// @returns nothing if there is no such job, or it was dismissed before
    virtual std::optional<StatusInfo> dismiss(const std::string& id, UnixMillis now) = 0;

    /// Takes jobs away from workers whose lease has run out: they wait again, or fail with
    /// `worker-lost` if they have had their attempts.
    /// @returns these jobs, as they are now
    virtual std::vector<StatusInfo> take_back_expired(std::uint64_t max_attempts,
                                                      UnixMillis now) = 0;
    /// The same for every job that runs, whatever its lease. Only for a start, with no other server
    /// on the same store.
    virtual std::vector<StatusInfo> take_back_all(std::uint64_t max_attempts, UnixMillis now) = 0;

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
