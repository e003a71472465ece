#include "server/sqlite_job_store.h"

#include <nlohmann/json.hpp>

#include "api/http_text.h"
#include "api/json_text.h"
#include "api/parameters.h"
#include "api/problem.h"
#include "core/base/error.h"
#include "server/ids.h"
#include "server/sqlite_schema.h"

namespace lpf::server {
namespace {

using nlohmann::json;

std::int64_t as_integer(std::uint64_t value) { return static_cast<std::int64_t>(value); }

json parse_stored(const std::string& text) {
    json document = json::parse(text, nullptr, false);
    if (document.is_discarded())
        throw Error(ErrorCode::StorageFailure, "A record of the job database is damaged.");
    return document;
}

StatusInfo status_from_text(const std::string& text) {
    return status_from_json(parse_stored(text));
}

std::string text_of(const StatusInfo& info) { return dump_json(to_json(info)); }

SqlValue optional_time(const std::optional<UnixMillis>& time) {
    return time ? SqlValue(*time) : SqlValue(nullptr);
}

/// Rows are numbered from 1, newest first: the cursor is the last number of the page before.
std::int64_t before(const std::string& cursor) {
    if (cursor.empty()) return std::numeric_limits<std::int64_t>::max();
    const auto number = parse_number(cursor);
    if (!number) {
        throw ProblemException(
            {.problem = ProblemCode::InvalidParameter,
             .detail = "The cursor is not one that a list gave.",
             .errors = {{"/cursor", "Take the link `next` of a list as it is."}}});
    }
    return static_cast<std::int64_t>(*number);
}

ResultKind kind_from_name(const std::string& name) {
    for (const ResultKind kind :
         {ResultKind::Points, ResultKind::Dictionary, ResultKind::Report, ResultKind::Fields})
        if (result_name(kind) == name) return kind;
    throw Error(ErrorCode::StorageFailure, "A record of the job database is damaged.");
}

std::vector<ResultFile> read_results(SqliteDatabase& db, const std::string& job_id) {
    std::vector<ResultFile> results;
    auto rows =
        db.query("SELECT name, type, bytes, sha256 FROM results WHERE job_id = ?", {job_id});
    while (rows.next()) {
        results.push_back({kind_from_name(rows.text(0)), rows.text(1),
                           static_cast<std::uint64_t>(rows.integer(2)), rows.text(3)});
    }
    return results;
}

std::optional<ShapeInfo> read_shape(SqliteDatabase& db, const std::string& where,
                                    const std::string& value) {
    auto rows = db.query("SELECT document FROM shapes WHERE " + where + " = ?", {value});
    if (!rows.next()) return std::nullopt;
    return shape_from_json(parse_stored(rows.text(0)));
}

constexpr const char* kUnfinished = "status IN ('accepted', 'running')";

StoredDictionary dictionary_in(const SqlRows& rows) {
    return {rows.text(1),    rows.text(2),    rows.text(3),
            rows.integer(4), rows.integer(5), rows.text(6)};
}

constexpr const char* kDictionaryColumns =
    "SELECT number, id, job_id, sha256, created, expires, summary FROM dictionaries ";

}  // namespace

SqliteJobStore::SqliteJobStore(const std::filesystem::path& file)
    : writer_(file, SqliteDatabase::Mode::ReadWrite),
      reader_((create_schema(writer_), file), SqliteDatabase::Mode::ReadOnly) {}

ShapeInfo SqliteJobStore::add_shape(const ShapeInfo& shape) {
    const std::lock_guard lock(write_mutex_);
    if (auto known = read_shape(writer_, "sha256", shape.sha256))
        return *extend_shape(std::move(known), shape.expires.value_or(0));
    writer_.run("INSERT INTO shapes (id, sha256, expires, document) VALUES (?, ?, ?, ?)",
                {shape.id, shape.sha256, shape.expires.value_or(0), dump_json(to_json(shape))});
    return shape;
}

std::optional<ShapeInfo> SqliteJobStore::find_shape(const std::string& id) const {
    const std::lock_guard lock(read_mutex_);
    return read_shape(reader_, "id", id);
}

std::optional<ShapeInfo> SqliteJobStore::find_shape_by_digest(const std::string& sha256) const {
    const std::lock_guard lock(read_mutex_);
    return read_shape(reader_, "sha256", sha256);
}

std::optional<ShapeInfo> SqliteJobStore::keep_shape_until(const std::string& id,
                                                          UnixMillis expires) {
    const std::lock_guard lock(write_mutex_);
    return extend_shape(read_shape(writer_, "id", id), expires);
}

std::optional<ShapeInfo> SqliteJobStore::extend_shape(std::optional<ShapeInfo> shape,
                                                      UnixMillis expires) {
    if (!shape || shape->expires.value_or(0) >= expires) return shape;
    shape->expires = expires;
    writer_.run("UPDATE shapes SET expires = ?, document = ? WHERE id = ?",
                {expires, dump_json(to_json(*shape)), shape->id});
    return shape;
}

bool SqliteJobStore::remove_shape(const std::string& id) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    {
        auto rows = writer_.query(
            std::string("SELECT id FROM jobs WHERE shape = ? AND ") + kUnfinished, {id});
        if (rows.next()) {
            throw ProblemException(ProblemCode::ShapeInUse,
                                   "Job " + rows.text(0) +
                                       " still needs this shape. Dismiss it, or wait for its end.");
        }
    }
    const bool removed = writer_.run("DELETE FROM shapes WHERE id = ?", {id}) > 0;
    transaction.commit();
    return removed;
}

void SqliteJobStore::add_job(const StatusInfo& job, std::uint64_t max_waiting) {
    const std::lock_guard lock(write_mutex_);
    SqlTransaction transaction(writer_);
    {
        auto waiting = writer_.query("SELECT count(*) FROM jobs WHERE status = 'accepted'");
        if (waiting.next() && waiting.integer(0) >= as_integer(max_waiting)) {
            throw ProblemException(
                {.problem = ProblemCode::QueueFull,
                 .detail = "The queue is full: " + std::to_string(max_waiting) +
                           " jobs wait already (queuedJobs). Try again in a while.",
                 .retry_after = 10});
        }
    }
    if (!read_shape(writer_, "id", job.shape))
        throw ProblemException(ProblemCode::ShapeNotFound, "The shape of this job was deleted.");
    writer_.run(
        "INSERT INTO jobs (id, process, status, shape, created, expires, document) "
        "VALUES (?, ?, ?, ?, ?, ?, ?)",
        {job.job_id, std::string(process_id(job.process)), std::string(status_name(job.status)),
         job.shape, job.created, optional_time(job.expires), text_of(job)});
    transaction.commit();
}

std::optional<StoredJob> SqliteJobStore::find_job(const std::string& id) const {
    const std::lock_guard lock(read_mutex_);
    StoredJob job;
    {
        auto rows = reader_.query(
            "SELECT document, status, (SELECT count(*) FROM jobs AS other WHERE "
            "other.status = 'accepted' AND other.number <= jobs.number) FROM jobs WHERE id = ?",
            {id});
        if (!rows.next()) return std::nullopt;
        job.info = status_from_text(rows.text(0));
        if (rows.text(1) == "accepted")
            job.info.queue_position = static_cast<std::uint64_t>(rows.integer(2));
    }
    job.results = read_results(reader_, id);
    job.results_expired = job.info.status == JobStatus::Successful && job.results.empty();
    return job;
}

JobPage SqliteJobStore::list_jobs(const JobFilter& filter) const {
    std::string sql = "SELECT number, document FROM jobs WHERE number < ?";
    std::vector<SqlValue> values{before(filter.cursor)};
    if (filter.status) {
        sql += " AND status = ?";
        values.emplace_back(std::string(status_name(*filter.status)));
    } else {
        sql += " AND status <> 'dismissed'";
    }
    if (filter.process) {
        sql += " AND process = ?";
        values.emplace_back(std::string(process_id(*filter.process)));
    }
    sql += " ORDER BY number DESC LIMIT ?";
    values.emplace_back(as_integer(filter.limit + 1));

    JobPage page;
    std::int64_t last = 0;
    const std::lock_guard lock(read_mutex_);
    auto rows = reader_.query(sql, values);
    while (rows.next()) {
        if (page.jobs.size() == filter.limit) {
            page.next_cursor = std::to_string(last);
            break;
        }
        last = rows.integer(0);
        page.jobs.push_back(status_from_text(rows.text(1)));
    }
    return page;
}

QueueFigures SqliteJobStore::figures() const {
    const std::lock_guard lock(read_mutex_);
    QueueFigures figures;
    auto rows = reader_.query("SELECT status, count(*), min(created) FROM jobs GROUP BY status");
    while (rows.next()) {
        const auto status = status_from_name(rows.text(0));
        if (!status) continue;
        figures.jobs[*status] = static_cast<std::uint64_t>(rows.integer(1));
        if (*status == JobStatus::Accepted) figures.oldest_accepted = rows.integer(2);
    }
    return figures;
}

std::optional<StoredDictionary> SqliteJobStore::find_dictionary(const std::string& id) const {
    const std::lock_guard lock(read_mutex_);
    auto rows = reader_.query(std::string(kDictionaryColumns) + "WHERE id = ?", {id});
    if (!rows.next()) return std::nullopt;
    return dictionary_in(rows);
}

DictionaryPage SqliteJobStore::list_dictionaries(std::size_t limit,
                                                 const std::string& cursor) const {
    DictionaryPage page;
    std::int64_t last = 0;
    const std::lock_guard lock(read_mutex_);
    auto rows = reader_.query(
        std::string(kDictionaryColumns) + "WHERE number < ? ORDER BY number DESC LIMIT ?",
        {before(cursor), as_integer(limit + 1)});
    while (rows.next()) {
        if (page.dictionaries.size() == limit) {
            page.next_cursor = std::to_string(last);
            break;
        }
        last = rows.integer(0);
        page.dictionaries.push_back(dictionary_in(rows));
    }
    return page;
}

bool SqliteJobStore::refers_to(const std::string& sha256) const {
    const std::lock_guard lock(write_mutex_);  // the writer sees what the reader may not see yet
    auto rows = writer_.query(
        "SELECT 1 FROM shapes WHERE sha256 = ?1 UNION ALL SELECT 1 FROM results WHERE sha256 = ?1 "
        "UNION ALL SELECT 1 FROM dictionaries WHERE sha256 = ?1 LIMIT 1",
        {sha256});
    return rows.next();
}

std::set<std::string> SqliteJobStore::all_digests() const {
    const std::lock_guard lock(write_mutex_);
    std::set<std::string> digests;
    auto rows = writer_.query(
        "SELECT sha256 FROM shapes UNION SELECT sha256 FROM results UNION "
        "SELECT sha256 FROM dictionaries");
    while (rows.next()) digests.insert(rows.text(0));
    return digests;
}

}  // namespace lpf::server
