#include "server/store/sqlite.h"

#include <sqlite3.h>

#include <cerrno>

#include "api/problem.h"
#include "core/base/error.h"

namespace lpf::server {
namespace {

constexpr int kPatienceMillis = 5000;        // for another program that holds the file
constexpr std::size_t kMaxStatements = 128;  // kept prepared; more than the program has
// The log is written back every 1000 pages, so that it stays small and a start is quick.
constexpr const char* kSettings =
    "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON; "
    "PRAGMA wal_autocheckpoint=1000;";

/// No room: SQLite names it for its files, but for shared memory only the system does.
bool is_disk_full(sqlite3* db) {
    const int code = sqlite3_errcode(db);
    if (code == SQLITE_FULL) return true;
    const int system = sqlite3_system_errno(db);
    return (code == SQLITE_IOERR || code == SQLITE_CANTOPEN) &&
           (system == ENOSPC || system == EDQUOT);
}

std::string advice(int code) {
    switch (code) {
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            return " The file jobs.sqlite in the data folder is damaged: put back a copy of the "
                   "data folder, or move it away and start with an empty one.";
        case SQLITE_READONLY:
        case SQLITE_CANTOPEN:
        case SQLITE_PERM:
            return " The server must be able to write to jobs.sqlite and to the data folder.";
        case SQLITE_BUSY:
        case SQLITE_LOCKED: return " Another program holds jobs.sqlite open.";
        default: return "";
    }
}

[[noreturn]] void fail(sqlite3* db, const std::string& what) {
    if (!db) throw Error(ErrorCode::StorageFailure, what + ": out of memory.");
    if (is_disk_full(db)) {
        throw ProblemException(ProblemCode::InsufficientStorage,
                               "The server's disk is full; try again later, or delete shapes and "
                               "jobs that are no longer needed.");
    }
    throw Error(ErrorCode::StorageFailure,
                what + ": " + sqlite3_errmsg(db) + "." + advice(sqlite3_errcode(db)));
}

void bind(sqlite3* db, sqlite3_stmt* statement, int index, const SqlValue& value) {
    int result = SQLITE_OK;
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
        result = sqlite3_bind_int64(statement, index, *integer);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
        result = sqlite3_bind_text64(statement, index, text->data(), text->size(), SQLITE_TRANSIENT,
                                     SQLITE_UTF8);
    } else {
        result = sqlite3_bind_null(statement, index);
    }
    if (result != SQLITE_OK) fail(db, "The job database refused a value");
}

}  // namespace

SqlRows::SqlRows(SqliteDatabase& db, std::string_view sql, const std::vector<SqlValue>& values)
    : db_(db), statement_(db.take_statement(sql)) {
    try {
        for (std::size_t i = 0; i < values.size(); ++i)
            bind(db_.db_, statement_, static_cast<int>(i + 1), values[i]);
    } catch (...) {
        db_.put_back(statement_);
        throw;
    }
}

SqlRows::~SqlRows() { db_.put_back(statement_); }

bool SqlRows::next() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail(db_.db_, "The job database failed");
    return result == SQLITE_ROW;
}

std::string SqlRows::text(int column) const {
    const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    if (!data) return {};
    return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_, column))};
}

std::int64_t SqlRows::integer(int column) const { return sqlite3_column_int64(statement_, column); }

SqliteDatabase::SqliteDatabase(const std::filesystem::path& file, Mode mode) {
    const int flags =
        mode == Mode::ReadWrite ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
    if (sqlite3_open_v2(file.c_str(), &db_, flags | SQLITE_OPEN_NOMUTEX, nullptr) != SQLITE_OK) {
        close_and_fail("The job database cannot be opened");
    }
    sqlite3_busy_timeout(db_, kPatienceMillis);
    if (mode == Mode::ReadOnly) return;
    if (sqlite3_exec(db_, kSettings, nullptr, nullptr, nullptr) != SQLITE_OK)
        close_and_fail("The job database cannot be used");
}

SqliteDatabase::~SqliteDatabase() {
    for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
    sqlite3_close(db_);
}

void SqliteDatabase::close_and_fail(const std::string& what) {
    try {
        fail(db_, what);
    } catch (...) {
        sqlite3_close(db_);
        throw;
    }
}

sqlite3_stmt* SqliteDatabase::take_statement(std::string_view sql) {
    if (const auto known = statements_.find(sql); known != statements_.end()) {
        sqlite3_stmt* statement = known->second;
        statements_.erase(known);
        return statement;
    }
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(db_, sql.data(), static_cast<int>(sql.size()), &statement, nullptr) !=
        SQLITE_OK)
        fail(db_, "The job database refused a statement");
    return statement;
}

void SqliteDatabase::put_back(sqlite3_stmt* statement) {
    sqlite3_reset(statement);
    sqlite3_clear_bindings(statement);
    if (statements_.size() < kMaxStatements) {
        statements_.emplace(sqlite3_sql(statement), statement);
    } else {
        sqlite3_finalize(statement);
    }
}

void SqliteDatabase::checkpoint() {
    // Best effort: readers may be in the way, and what is not moved now is moved at the next start.
    sqlite3_wal_checkpoint_v2(db_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr, nullptr);
}

SqlRows SqliteDatabase::query(std::string_view sql, const std::vector<SqlValue>& values) {
    return {*this, sql, values};
}

std::size_t SqliteDatabase::run(std::string_view sql, const std::vector<SqlValue>& values) {
    SqlRows rows(*this, sql, values);
    while (rows.next()) {
    }
    return static_cast<std::size_t>(sqlite3_changes64(db_));
}

void SqliteDatabase::script(const std::string& sql) {
    if (sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
        fail(db_, "The job database failed");
}

std::int64_t SqliteDatabase::user_version() {
    auto rows = query("PRAGMA user_version");
    return rows.next() ? rows.integer(0) : 0;
}

SqlTransaction::~SqlTransaction() {
    if (!open_) return;
    try {
        db_.script("ROLLBACK");
    } catch (...) {  // SQLite has rolled back by itself
    }
}

void SqlTransaction::commit() {
    db_.script("COMMIT");
    open_ = false;
}

}  // namespace lpf::server
