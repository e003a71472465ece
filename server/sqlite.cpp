#include "server/sqlite.h"

#include <sqlite3.h>

#include "core/base/error.h"

namespace lpf::server {
namespace {

[[noreturn]] void fail(sqlite3* db, const std::string& what) {
    throw Error(ErrorCode::StorageFailure,
                what + ": " + (db ? sqlite3_errmsg(db) : "out of memory") + ".");
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

SqlRows::SqlRows(sqlite3* db, std::string_view sql, const std::vector<SqlValue>& values) : db_(db) {
    if (sqlite3_prepare_v2(db, sql.data(), static_cast<int>(sql.size()), &statement_, nullptr) !=
        SQLITE_OK)
        fail(db, "The job database refused a statement");
    try {
        for (std::size_t i = 0; i < values.size(); ++i)
            bind(db, statement_, static_cast<int>(i + 1), values[i]);
    } catch (...) {
        sqlite3_finalize(statement_);
        throw;
    }
}

SqlRows::~SqlRows() { sqlite3_finalize(statement_); }

bool SqlRows::next() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail(db_, "The job database failed");
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
        const std::string why = db_ ? sqlite3_errmsg(db_) : "out of memory";
        sqlite3_close(db_);
        throw Error(ErrorCode::StorageFailure, "The job database cannot be opened: " + why + ".");
    }
    sqlite3_busy_timeout(db_, 5000);
    try {
        if (mode == Mode::ReadWrite)
            script("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON;");
    } catch (...) {
        sqlite3_close(db_);
        throw;
    }
}

SqliteDatabase::~SqliteDatabase() { sqlite3_close(db_); }

SqlRows SqliteDatabase::query(std::string_view sql, const std::vector<SqlValue>& values) {
    return {db_, sql, values};
}

std::size_t SqliteDatabase::run(std::string_view sql, const std::vector<SqlValue>& values) {
    SqlRows rows(db_, sql, values);
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
    } catch (const Error&) {  // SQLite has rolled back by itself
    }
}

void SqlTransaction::commit() {
    db_.script("COMMIT");
    open_ = false;
}

}  // namespace lpf::server
