#pragma once

#include <filesystem>
#include <mutex>

#include "server/job_store.h"
#include "server/store/sqlite.h"
#include "server/store/sqlite_writer.h"

namespace lpf::server {

/// The books in one SQLite file. A job's document is kept as the JSON that the client sees; what is
/// searched for has columns of its own.
class SqliteJobStore : public JobStore {
public:
    /// Opens or makes the file. @throws Error{StorageFailure}, also for a file of a newer program
    explicit SqliteJobStore(const std::filesystem::path& file);
    ~SqliteJobStore() override;
    SqliteJobStore(const SqliteJobStore&) = delete;
    SqliteJobStore& operator=(const SqliteJobStore&) = delete;

    ShapeInfo add_shape(const ShapeInfo& shape) override;
    [[nodiscard]] std::optional<ShapeInfo> find_shape(const std::string& id) const override;
    [[nodiscard]] std::optional<ShapeInfo> find_shape_by_digest(
        const std::string& sha256) const override;
    std::optional<ShapeInfo> keep_shape_until(const std::string& id, UnixMillis expires) override;
    bool remove_shape(const std::string& id) override;

    void add_job(const NewJob& job, const QueueLimits& limits) override;
    [[nodiscard]] std::optional<MarkedRequest> find_request(const std::string& owner,
                                                            const std::string& key) const override;
    [[nodiscard]] std::optional<StoredJob> find_job(const std::string& id) const override;
    [[nodiscard]] JobPage list_jobs(const JobFilter& filter) const override;
    [[nodiscard]] QueueFigures figures() const override;
    [[nodiscard]] std::vector<WaitingJob> waiting() const override;
    [[nodiscard]] std::vector<PastJob> past_jobs(std::size_t limit) const override;

    std::optional<ClaimedJob> claim_next(const ClaimRequest& request) override;
    bool extend(const Lease& lease, UnixMillis now, UnixMillis until) override;
    bool save_progress(const Lease& lease, const StatusInfo& info, UnixMillis now) override;
    bool finish(const Lease& lease, const StatusInfo& info, const std::vector<ResultFile>& results,
                const std::optional<StoredDictionary>& dictionary, UnixMillis now) override;
    bool give_back(const Lease& lease, UnixMillis now) override;
    std::optional<StatusInfo> dismiss(const std::string& id, UnixMillis now) override;
    std::vector<StatusInfo> take_back_expired(std::uint64_t max_attempts, UnixMillis now) override;
    std::vector<StatusInfo> take_back_all(std::uint64_t max_attempts, UnixMillis now) override;

    [[nodiscard]] std::optional<StoredDictionary> find_dictionary(
        const std::string& id) const override;
    [[nodiscard]] DictionaryPage list_dictionaries(std::size_t limit,
                                                   const std::string& cursor) const override;

    std::size_t remove_expired(UnixMillis now, UnixMillis status_retention) override;
    [[nodiscard]] bool refers_to(const std::string& sha256) const override;
    [[nodiscard]] std::set<std::string> all_digests() const override;

private:
    std::vector<StatusInfo> take_back(std::uint64_t max_attempts, UnixMillis now,
                                      UnixMillis leases_until);

    // Readers do not wait for a writer that waits for the disk: two connections.
    SqliteDatabase write_connection_;
    SqliteWriter writer_;
    mutable std::mutex read_mutex_;
    mutable SqliteDatabase reader_;
};

}  // namespace lpf::server
