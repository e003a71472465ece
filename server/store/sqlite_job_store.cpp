#include "server/store/sqlite_job_store.h"

#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "api/parameters.h"
#include "api/problem.h"
#include "server/store/folder.h"
#include "server/store/sqlite_records.h"
#include "server/store/sqlite_schema.h"

namespace lpf::server {

using namespace records;

namespace {

ShapeInfo extended(SqliteDatabase& db, ShapeInfo shape, UnixMillis expires) {
    if (shape.expires.value_or(0) >= expires) return shape;
    shape.expires = expires;
    db.run("UPDATE shapes SET expires = ?, document = ? WHERE id = ?",
           {expires, dump_json(to_json(shape)), shape.id});
    return shape;
}

StoredDictionary dictionary_in(const SqlRows& rows) {
    return {rows.text(1),    rows.text(2),    rows.text(3),
            rows.integer(4), rows.integer(5), rows.text(6)};
}

constexpr const char* kDictionaryColumns =
    "SELECT number, id, job_id, sha256, created, expires, summary FROM dictionaries ";

}  // namespace

SqliteJobStore::SqliteJobStore(const std::filesystem::path& file)
    : write_connection_(file, SqliteDatabase::Mode::ReadWrite),
      writer_((create_schema(write_connection_), write_connection_)),
      reader_(file, SqliteDatabase::Mode::ReadOnly) {
    sync_folder(std::filesystem::absolute(file).parent_path());  // the new file has a name for good
}

SqliteJobStore::~SqliteJobStore() { write_connection_.checkpoint(); }

ShapeInfo SqliteJobStore::add_shape(const ShapeInfo& shape) {
    return writer_.write([&](SqliteDatabase& db) {
        if (auto known = read_shape(db, "sha256", shape.sha256))
            return extended(db, *std::move(known), shape.expires.value_or(0));
        db.run("INSERT INTO shapes (id, sha256, expires, document) VALUES (?, ?, ?, ?)",
               {shape.id, shape.sha256, shape.expires.value_or(0), dump_json(to_json(shape))});
        return shape;
    });
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
    return writer_.write([&](SqliteDatabase& db) -> std::optional<ShapeInfo> {
        auto shape = read_shape(db, "id", id);
        if (!shape) return std::nullopt;
        return extended(db, *std::move(shape), expires);
    });
}

bool SqliteJobStore::remove_shape(const std::string& id) {
    return writer_.write([&](SqliteDatabase& db) {
        auto rows = db.query(
            "SELECT id FROM jobs WHERE shape = ? AND status IN ('accepted', 'running')", {id});
        if (rows.next()) {
            throw ProblemException(ProblemCode::ShapeInUse,
                                   "Job " + rows.text(0) +
                                       " still needs this shape. Dismiss it, or wait for its end.");
        }
        return db.run("DELETE FROM shapes WHERE id = ?", {id}) > 0;
    });
}

std::optional<StoredJob> SqliteJobStore::find_job(const std::string& id) const {
    const std::lock_guard lock(read_mutex_);
    auto info = read_job(reader_, id);
    if (!info) return std::nullopt;
    StoredJob job{.info = *std::move(info), .results = read_results(reader_, id)};
    job.results_expired = job.info.status == JobStatus::Successful && job.results.empty();
    auto retries = reader_.query("SELECT id FROM jobs WHERE retry_of = ? ORDER BY number", {id});
    while (retries.next()) job.info.retries.push_back(retries.text(0));
    return job;
}

std::optional<MarkedRequest> SqliteJobStore::find_request(const std::string& owner,
                                                          const std::string& key) const {
    const std::lock_guard lock(read_mutex_);
    auto rows = reader_.query(
        "SELECT fingerprint, job_id FROM requests WHERE owner = ? AND key = ?", {owner, key});
    if (!rows.next()) return std::nullopt;
    return MarkedRequest{rows.text(0), rows.text(1)};
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
    values.emplace_back(number(filter.limit + 1));

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
        {before(cursor), number(limit + 1)});
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
    const std::lock_guard lock(read_mutex_);
    auto rows = reader_.query(
        "SELECT 1 FROM shapes WHERE sha256 = ?1 UNION ALL SELECT 1 FROM results WHERE sha256 = ?1 "
        "UNION ALL SELECT 1 FROM dictionaries WHERE sha256 = ?1 LIMIT 1",
        {sha256});
    return rows.next();
}

std::set<std::string> SqliteJobStore::all_digests() const {
    const std::lock_guard lock(read_mutex_);
    std::set<std::string> digests;
    auto rows = reader_.query(
        "SELECT sha256 FROM shapes UNION SELECT sha256 FROM results UNION "
        "SELECT sha256 FROM dictionaries");
    while (rows.next()) digests.insert(rows.text(0));
    return digests;
}

}  // namespace lpf::server
