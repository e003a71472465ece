#include "server/store/sqlite_records.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "api/http_text.h"
#include "api/json_text.h"
#include "api/parameters.h"
#include "api/problem.h"
#include "core/base/error.h"

namespace lpf::server::records {
namespace {

[[noreturn]] void damaged() {
    throw Error(ErrorCode::StorageFailure, "A record of the job database is damaged.");
}

nlohmann::json parse_stored(const std::string& text) {
    nlohmann::json document = nlohmann::json::parse(text, nullptr, false);
    if (document.is_discarded()) damaged();
    return document;
}

ResultKind kind_from_name(const std::string& name) {
    for (const ResultKind kind :
         {ResultKind::Points, ResultKind::Dictionary, ResultKind::Report, ResultKind::Fields})
        if (result_name(kind) == name) return kind;
    damaged();
}

constexpr const char* kSetJob =
    "UPDATE jobs SET status = ?1, finished = ?2, expires = ?3, started = ?4, document = ?5, "
    "lease = CASE ?1 WHEN 'running' THEN lease ELSE '' END WHERE id = ?6";

std::vector<SqlValue> values_of(const StatusInfo& info) {
    return {std::string(status_name(info.status)),
            optional_time(info.finished),
            optional_time(info.expires),
            optional_time(info.started),
            dump_json(to_json(info)),
            info.job_id};
}

}  // namespace

SqlValue optional_time(const std::optional<UnixMillis>& time) {
    return time ? SqlValue(*time) : SqlValue(nullptr);
}

StatusInfo status_from_text(const std::string& text) {
    return status_from_json(parse_stored(text));
}

std::optional<StatusInfo> read_job(SqliteDatabase& db, const std::string& id) {
    auto rows = db.query("SELECT document FROM jobs WHERE id = ?", {id});
    if (!rows.next()) return std::nullopt;
    return status_from_text(rows.text(0));
}

void write_job(SqliteDatabase& db, const StatusInfo& info) { db.run(kSetJob, values_of(info)); }

bool write_job(SqliteDatabase& db, const StatusInfo& info, const Lease& lease, UnixMillis now) {
    std::vector<SqlValue> values = values_of(info);
    values.emplace_back(lease.token);
    values.emplace_back(now);
    return db.run(std::string(kSetJob) + " AND lease = ?7 AND lease_until > ?8", values) > 0;
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

std::vector<WaitingJob> read_waiting(SqliteDatabase& db) {
    std::vector<WaitingJob> jobs;
    auto rows = db.query(
        "SELECT id, owner, process, points, rank, memory FROM jobs WHERE status = 'accepted' "
        "ORDER BY number");
    while (rows.next()) {
        const auto task = task_from_id(rows.text(2));
        if (!task) damaged();
        jobs.push_back({rows.text(0), rows.text(1), *task,
                        static_cast<std::uint64_t>(rows.integer(3)), rows.integer(4),
                        static_cast<std::uint64_t>(rows.integer(5))});
    }
    return jobs;
}

Owners read_owners(SqliteDatabase& db) {
    Owners owners;
    auto turns = db.query("SELECT owner, last FROM turns");
    while (turns.next())
        owners[turns.text(0)].last_turn = static_cast<std::uint64_t>(turns.integer(1));
    auto running =
        db.query("SELECT owner, count(*) FROM jobs WHERE status = 'running' GROUP BY owner");
    while (running.next())
        owners[running.text(0)].running = static_cast<std::uint64_t>(running.integer(1));
    return owners;
}

std::int64_t before(const std::string& cursor) {
    // Rows are numbered from 1, newest first: the cursor is the last number of the page before.
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

}  // namespace lpf::server::records
