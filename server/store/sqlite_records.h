#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/job_store.h"
#include "server/store/sqlite.h"

/// Rows of the tables as the types of the store. Part of SqliteJobStore.
namespace lpf::server::records {

/// @throws Error{StorageFailure} if the text is damaged
[[nodiscard]] StatusInfo status_from_text(const std::string& text);
[[nodiscard]] std::optional<StatusInfo> read_job(SqliteDatabase& db, const std::string& id);

/// Writes the state of a job, ending its lease unless it runs.
void write_job(SqliteDatabase& db, const StatusInfo& info);
/// The same for a worker: only while its lease holds. @returns false if it does not
bool write_job(SqliteDatabase& db, const StatusInfo& info, const Lease& lease, UnixMillis now);

[[nodiscard]] std::vector<ResultFile> read_results(SqliteDatabase& db, const std::string& job_id);

/// @param where column that identifies it: "id" or "sha256"
[[nodiscard]] std::optional<ShapeInfo> read_shape(SqliteDatabase& db, const std::string& where,
                                                  const std::string& value);

/// In the order of their arrival.
[[nodiscard]] std::vector<WaitingJob> read_waiting(SqliteDatabase& db);
[[nodiscard]] Owners read_owners(SqliteDatabase& db);

/// A number of a row as the cursor of a page; the next page begins before it.
[[nodiscard]] std::int64_t before(const std::string& cursor);

[[nodiscard]] SqlValue optional_time(const std::optional<UnixMillis>& time);
[[nodiscard]] inline SqlValue number(std::uint64_t value) {
    return static_cast<std::int64_t>(value);
}

}  // namespace lpf::server::records
