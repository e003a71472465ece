// The part of SqliteJobStore that changes jobs: claims, ends, recoveries, expiry.
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "api/parameters.h"
#include "core/base/error.h"
#include "server/ids.h"
#include "server/sqlite_job_store.h"

namespace lpf::server {
namespace {

SqlValue optional_time(const std::optional<UnixMillis>& time) {
    return time ? SqlValue(*time) : SqlValue(nullptr);
}

/// As if it had not been started; what was found out on the way is found out again.
StatusInfo waiting_again(StatusInfo info, UnixMillis now) {
    info.status = JobStatus::Accepted;
    info.updated = now;
    info.progress = 0;
    info.started.reset();
    info.phase.clear();
    info.phase_progress.reset();
    info.eta_seconds.reset();
    info.resolved_parameters.clear();
    info.warnings.clear();
    info.message = "Waiting for a worker.";
    return info;
}

StatusInfo worker_lost(StatusInfo info, UnixMillis now) {
    info.status = JobStatus::Failed;
    info.updated = now;
    info.finished = now;
    info.exception = Problem{
        .problem = ProblemCode::WorkerLost,
        .detail = "The server stopped " + std::to_string(info.attempt) +
                  " times while it worked on this job, which is therefore not tried again. The "
                  "shape may need more memory than there is.",
        .instance = "/v1/jobs/" + info.job_id};
    info.message = info.exception->detail;
    return info;
}

}  // namespace

std::optional<StatusInfo> SqliteJobStore::read_document(const std::string& id) {
    auto rows = writer_.query("SELECT document FROM jobs WHERE id = ?", {id});
    if (!rows.next()) return std::nullopt;
    const auto document = nlohmann::json::parse(rows.text(0), nullptr, false);
    if (document.is_discarded())
        throw Error(ErrorCode::StorageFailure, "A record of the job database is damaged.");
    return status_from_json(document);
}

bool SqliteJobStore::write_document(const StatusInfo& info, const std::string& lease) {
    const bool running = info.status == JobStatus::Running;
    return writer_.run(
               "UPDATE jobs SET status = ?, finished = ?, expires = ?, lease = ?, document = ? "
               "WHERE id = ? AND (lease = ? OR ? = '')",
               {std::string(status_name(info.status)), optional_time(info.finished),
                optional_time(info.expires), running ? lease : std::string(),
                dump_json(to_json(info)), info.job_id, lease, lease}) > 0;
}

std::optional<ClaimedJob> SqliteJobStore::claim_next(UnixMillis now) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    std::string id;
    {
        auto rows =
            writer_.query("SELECT id FROM jobs WHERE status = 'accepted' ORDER BY number LIMIT 1");
        if (!rows.next()) return std::nullopt;
        id = rows.text(0);
    }
    ClaimedJob claim{*read_document(id), {id, new_id()}};
    claim.info.status = JobStatus::Running;
    claim.info.message = "Running.";
    claim.info.started = now;
    claim.info.updated = now;
    ++claim.info.attempt;
    writer_.run("UPDATE jobs SET status = 'running', lease = ?, document = ? WHERE id = ?",
                {claim.lease.token, dump_json(to_json(claim.info)), id});
    transaction.commit();
    return claim;
}

bool SqliteJobStore::save_progress(const Lease& lease, const StatusInfo& info) {
    const std::lock_guard lock(write_mutex_);
    return write_document(info, lease.token);
}

bool SqliteJobStore::finish(const Lease& lease, const StatusInfo& info,
                            const std::vector<ResultFile>& results,
                            const std::optional<StoredDictionary>& dictionary) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    if (!write_document(info, lease.token)) return false;
    for (const ResultFile& file : results) {
        writer_.run(
            "INSERT INTO results (job_id, name, type, bytes, sha256) VALUES (?, ?, ?, ?, ?)",
            {info.job_id, std::string(result_name(file.kind)), file.type,
             static_cast<std::int64_t>(file.bytes), file.sha256});
    }
    if (dictionary) {
        writer_.run(
            "INSERT INTO dictionaries (id, job_id, sha256, created, expires, summary) "
            "VALUES (?, ?, ?, ?, ?, ?)",
            {dictionary->id, dictionary->job_id, dictionary->sha256, dictionary->created,
             dictionary->expires, dictionary->summary});
    }
    transaction.commit();
    return true;
}

bool SqliteJobStore::give_back(const Lease& lease, UnixMillis now) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    auto info = read_document(lease.job_id);
    if (!info) return false;
    *info = waiting_again(*info, now);
    info->attempt = std::max(0, info->attempt - 1);
    if (!write_document(*info, lease.token)) return false;
    transaction.commit();
    return true;
}

std::optional<StatusInfo> SqliteJobStore::dismiss(const std::string& id, UnixMillis now) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    auto info = read_document(id);
    if (!info || info->status == JobStatus::Dismissed) return std::nullopt;
    info->status = JobStatus::Dismissed;
    info->message = "Dismissed.";
    info->updated = now;
    info->finished = info->finished.value_or(now);
    info->eta_seconds.reset();
    write_document(*info, {});
    writer_.run("DELETE FROM results WHERE job_id = ?", {id});
    transaction.commit();
    return info;
}

std::size_t SqliteJobStore::recover(std::uint64_t max_attempts, UnixMillis now) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    std::vector<std::string> lost;
    {
        auto rows = writer_.query("SELECT id FROM jobs WHERE status = 'running'");
        while (rows.next()) lost.push_back(rows.text(0));
    }
    for (const std::string& id : lost) {
        const StatusInfo info = *read_document(id);
        const bool again = static_cast<std::uint64_t>(info.attempt) < max_attempts;
        write_document(again ? waiting_again(info, now) : worker_lost(info, now), {});
    }
    transaction.commit();
    return lost.size();
}

std::size_t SqliteJobStore::remove_expired(UnixMillis now, UnixMillis status_retention) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    std::size_t removed = writer_.run(
        "DELETE FROM results WHERE job_id IN (SELECT id FROM jobs WHERE expires <= ? AND status "
        "NOT IN ('accepted', 'running'))",
        {now});
    removed += writer_.run("DELETE FROM dictionaries WHERE expires <= ?", {now});
    removed += writer_.run("DELETE FROM jobs WHERE finished <= ?", {now - status_retention});
    removed += writer_.run(
        "DELETE FROM shapes WHERE expires <= ? AND id NOT IN (SELECT shape FROM jobs WHERE status "
        "IN ('accepted', 'running'))",
        {now});
    transaction.commit();
    return removed;
}

}  // namespace lpf::server
