// The part of SqliteJobStore that changes jobs: arrivals, claims, ends, losses, expiry.
#include "api/parameters.h"
#include "api/problem.h"
#include "server/ids.h"
#include "server/store/sqlite_job_store.h"
#include "server/store/sqlite_records.h"

namespace lpf::server {

using namespace records;

namespace {

constexpr UnixMillis kForever = std::numeric_limits<UnixMillis>::max();

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

void require_place(SqliteDatabase& db, const std::string& owner, const QueueLimits& limits) {
    auto rows = db.query(
        "SELECT count(*), count(*) FILTER (WHERE owner = ?) FROM jobs WHERE status = 'accepted'",
        {owner});
    rows.next();
    constexpr int kRetrySeconds = 10;
    if (rows.integer(0) >= static_cast<std::int64_t>(limits.waiting)) {
        throw ProblemException({.problem = ProblemCode::QueueFull,
                                .detail = "The queue is full: " + std::to_string(limits.waiting) +
                                          " jobs wait already (queuedJobs). Try again in a while.",
                                .retry_after = kRetrySeconds});
    }
    if (!owner.empty() && rows.integer(1) >= static_cast<std::int64_t>(limits.waiting_per_owner)) {
        throw ProblemException(
            {.problem = ProblemCode::QuotaExceeded,
             .detail = "This API key has " + std::to_string(limits.waiting_per_owner) +
                       " jobs waiting already (queuedJobsPerKey). Try again when some have "
                       "started.",
             .retry_after = kRetrySeconds});
    }
}

void add_request(SqliteDatabase& db, const NewJob& job) {
    const std::size_t added = db.run(
        "INSERT INTO requests (owner, key, fingerprint, job_id) VALUES (?, ?, ?, ?) "
        "ON CONFLICT (owner, key) DO NOTHING",
        {job.owner, job.mark->key, job.mark->fingerprint, job.info.job_id});
    if (added > 0) return;
    throw ProblemException({.problem = ProblemCode::IdempotencyConflict,
                            .detail = "A request with this Idempotency-Key has just made a job. "
                                      "Send it again to be told which.",
                            .retry_after = 1});
}

void note_turn(SqliteDatabase& db, const std::string& owner) {
    db.run(
        "INSERT INTO turns (owner, last) VALUES (?, (SELECT coalesce(max(last), 0) + 1 FROM turns))"
        " ON CONFLICT (owner) DO UPDATE SET last = excluded.last",
        {owner});
}

}  // namespace

void SqliteJobStore::add_job(const NewJob& job, const QueueLimits& limits) {
    const StatusInfo& info = job.info;
    writer_.write([&](SqliteDatabase& db) {
        require_place(db, job.owner, limits);
        if (!read_shape(db, "id", info.shape)) {
            throw ProblemException(ProblemCode::ShapeNotFound,
                                   "The shape of this job was deleted.");
        }
        db.run(
            "INSERT INTO jobs (id, process, status, shape, created, expires, document, owner, "
            "points, rank, memory, retry_of) "
            "VALUES (?, ?, 'accepted', ?, ?, ?, '', ?, ?, ?, ?, ?)",
            {info.job_id, std::string(process_id(info.process)), info.shape, info.created,
             optional_time(info.expires), job.owner, number(job.points),
             rank_of(info.created, job.points), number(job.memory),
             info.retry_of ? SqlValue(*info.retry_of) : SqlValue(nullptr)});
        write_job(db, info);
        if (job.mark) add_request(db, job);
    });
}

std::vector<WaitingJob> SqliteJobStore::waiting() const {
    const std::lock_guard lock(read_mutex_);
    return in_turn(read_waiting(reader_), read_owners(reader_));
}

std::vector<PastJob> SqliteJobStore::past_jobs(std::size_t limit) const {
    const std::lock_guard lock(read_mutex_);
    std::vector<PastJob> jobs;
    auto rows = reader_.query(
        "SELECT process, points, finished - started FROM jobs WHERE status = 'successful' AND "
        "started IS NOT NULL ORDER BY number DESC LIMIT ?",
        {number(limit)});
    while (rows.next()) {
        if (const auto task = task_from_id(rows.text(0))) {
            jobs.push_back({*task, static_cast<std::uint64_t>(rows.integer(1)),
                            static_cast<double>(rows.integer(2)) / 1000.0});
        }
    }
    return jobs;
}

std::optional<ClaimedJob> SqliteJobStore::claim_next(const ClaimRequest& request) {
    return writer_.write([&](SqliteDatabase& db) -> std::optional<ClaimedJob> {
        const Owners owners = read_owners(db);
        const std::vector<WaitingJob> waiting = in_turn(read_waiting(db), owners);
        const WaitingJob* next = next_turn(waiting, owners, request.rules);
        if (!next) return std::nullopt;
        ClaimedJob claim{.info = *read_job(db, next->id),
                         .lease = {next->id, new_id()},
                         .points = next->points,
                         .memory = next->memory,
                         .lease_until = request.lease_until};
        claim.info.status = JobStatus::Running;
        claim.info.message = "Running.";
        claim.info.started = request.now;
        claim.info.updated = request.now;
        ++claim.info.attempt;
        write_job(db, claim.info);
        db.run("UPDATE jobs SET lease = ?, lease_until = ? WHERE id = ?",
               {claim.lease.token, request.lease_until, next->id});
        note_turn(db, next->owner);
        return claim;
    });
}

bool SqliteJobStore::extend(const Lease& lease, UnixMillis now, UnixMillis until) {
    return writer_.write([&](SqliteDatabase& db) {
        return db.run(
                   "UPDATE jobs SET lease_until = ? WHERE id = ? AND lease = ? AND lease_until > ?",
                   {until, lease.job_id, lease.token, now}) > 0;
    });
}

bool SqliteJobStore::save_progress(const Lease& lease, const StatusInfo& info, UnixMillis now) {
    return writer_.write([&](SqliteDatabase& db) { return write_job(db, info, lease, now); });
}

bool SqliteJobStore::finish(const Lease& lease, const StatusInfo& info,
                            const std::vector<ResultFile>& results,
                            const std::optional<StoredDictionary>& dictionary, UnixMillis now) {
    return writer_.write([&](SqliteDatabase& db) {
        if (!write_job(db, info, lease, now)) return false;
        for (const ResultFile& file : results) {
            db.run("INSERT INTO results (job_id, name, type, bytes, sha256) VALUES (?, ?, ?, ?, ?)",
                   {info.job_id, std::string(result_name(file.kind)), file.type, number(file.bytes),
                    file.sha256});
        }
        if (dictionary) {
            db.run(
                "INSERT INTO dictionaries (id, job_id, sha256, created, expires, summary) "
                "VALUES (?, ?, ?, ?, ?, ?)",
                {dictionary->id, dictionary->job_id, dictionary->sha256, dictionary->created,
                 dictionary->expires, dictionary->summary});
        }
        return true;
    });
}

bool SqliteJobStore::give_back(const Lease& lease, UnixMillis now) {
    return writer_.write([&](SqliteDatabase& db) {
        auto info = read_job(db, lease.job_id);
        if (!info) return false;
        *info = waiting_again(*info, now);
        info->attempt = std::max(0, info->attempt - 1);
        return write_job(db, *info, lease, now);
    });
}

std::optional<StatusInfo> SqliteJobStore::dismiss(const std::string& id, UnixMillis now) {
    return writer_.write([&](SqliteDatabase& db) -> std::optional<StatusInfo> {
        auto info = read_job(db, id);
        if (!info || info->status == JobStatus::Dismissed) return std::nullopt;
        info->status = JobStatus::Dismissed;
        info->message = "Dismissed.";
        info->updated = now;
        info->finished = info->finished.value_or(now);
        info->eta_seconds.reset();
        write_job(db, *info);
        db.run("DELETE FROM results WHERE job_id = ?", {id});
        return info;
    });
}

std::vector<StatusInfo> SqliteJobStore::take_back_expired(std::uint64_t max_attempts,
                                                          UnixMillis now) {
    {  // most often there are none, and the disk is left in peace
        const std::lock_guard lock(read_mutex_);
        auto rows = reader_.query(
            "SELECT 1 FROM jobs WHERE status = 'running' AND lease_until <= ? LIMIT 1", {now});
        if (!rows.next()) return {};
    }
    return take_back(max_attempts, now, now);
}

std::vector<StatusInfo> SqliteJobStore::take_back_all(std::uint64_t max_attempts, UnixMillis now) {
    return take_back(max_attempts, now, kForever);
}

std::vector<StatusInfo> SqliteJobStore::take_back(std::uint64_t max_attempts, UnixMillis now,
                                                  UnixMillis leases_until) {
    return writer_.write([&](SqliteDatabase& db) {
        std::vector<StatusInfo> lost;
        auto rows = db.query(
            "SELECT document FROM jobs WHERE status = 'running' AND lease_until <= ? "
            "ORDER BY number",
            {leases_until});
        while (rows.next()) {
            const StatusInfo info = status_from_text(rows.text(0));
            const bool again = static_cast<std::uint64_t>(info.attempt) < max_attempts;
            lost.push_back(again ? waiting_again(info, now) : worker_lost(info, now));
        }
        for (const StatusInfo& info : lost) write_job(db, info);
        return lost;
    });
}

std::size_t SqliteJobStore::remove_expired(UnixMillis now, UnixMillis status_retention) {
    return writer_.write([&](SqliteDatabase& db) {
        std::size_t removed = db.run(
            "DELETE FROM results WHERE job_id IN (SELECT id FROM jobs WHERE expires <= ? AND "
            "status NOT IN ('accepted', 'running'))",
            {now});
        removed += db.run("DELETE FROM dictionaries WHERE expires <= ?", {now});
        removed += db.run("DELETE FROM jobs WHERE finished <= ?", {now - status_retention});
        removed += db.run(
            "DELETE FROM shapes WHERE expires <= ? AND id NOT IN (SELECT shape FROM jobs WHERE "
            "status IN ('accepted', 'running'))",
            {now});
        return removed;
    });
}

}  // namespace lpf::server
