#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace lpf::server {

using SqlValue = std::variant<std::nullptr_t, std::int64_t, std::string>;

class SqliteDatabase;

/// One prepared statement while it runs: bind in the constructor, then step through the rows.
class SqlRows {
public:
    SqlRows(SqliteDatabase& db, std::string_view sql, const std::vector<SqlValue>& values);
    ~SqlRows();
    SqlRows(const SqlRows&) = delete;
    SqlRows& operator=(const SqlRows&) = delete;

    /// @returns false after the last row
    bool next();
    [[nodiscard]] std::string text(int column) const;
    [[nodiscard]] std::int64_t integer(int column) const;

private:
    SqliteDatabase& db_;
    sqlite3_stmt* statement_;
};

/// A connection to an SQLite database: WAL, every commit on the disk before it returns. For one
/// thread at a time. All functions throw Error{StorageFailure}, and
/// ProblemException{InsufficientStorage} when the disk is full.
class SqliteDatabase {
public:
    enum class Mode { ReadWrite, ReadOnly };
    SqliteDatabase(const std::filesystem::path& file, Mode mode);
    ~SqliteDatabase();
    SqliteDatabase(const SqliteDatabase&) = delete;
    SqliteDatabase& operator=(const SqliteDatabase&) = delete;

    [[nodiscard]] SqlRows query(std::string_view sql, const std::vector<SqlValue>& values = {});
    /// Runs one statement. @returns number of rows changed
    std::size_t run(std::string_view sql, const std::vector<SqlValue>& values = {});
    /// Runs several statements that take no values.
    void script(const std::string& sql);

    [[nodiscard]] std::int64_t user_version();

    /// Moves what is in the write-ahead log into the file, and empties it. Never throws.
    void checkpoint();

private:
    friend class SqlRows;
    [[noreturn]] void close_and_fail(const std::string& what);
    sqlite3_stmt* take_statement(std::string_view sql);
    void put_back(sqlite3_stmt* statement);

    sqlite3* db_ = nullptr;
    // Prepared and not in use. A text that is in use twice is prepared twice.
    std::multimap<std::string, sqlite3_stmt*, std::less<>> statements_;
};

/// Rolls back unless committed.
class SqlTransaction {
public:
    explicit SqlTransaction(SqliteDatabase& db) : db_(db) { db_.script("BEGIN IMMEDIATE"); }
    ~SqlTransaction();
    SqlTransaction(const SqlTransaction&) = delete;
    SqlTransaction& operator=(const SqlTransaction&) = delete;

    void commit();

private:
    SqliteDatabase& db_;
    bool open_ = true;
};

}  // namespace lpf::server
