#include "server/sqlite_schema.h"

#include "core/base/error.h"

namespace lpf::server {
namespace {

constexpr std::int64_t kVersion = 1;

constexpr const char* kTables = R"sql(
CREATE TABLE shapes (
    id       TEXT PRIMARY KEY,
    sha256   TEXT NOT NULL UNIQUE,
    expires  INTEGER NOT NULL,
    document TEXT NOT NULL
);
CREATE TABLE jobs (
    number   INTEGER PRIMARY KEY AUTOINCREMENT,  -- order of arrival
    id       TEXT NOT NULL UNIQUE,
    process  TEXT NOT NULL,
    status   TEXT NOT NULL,
    shape    TEXT NOT NULL,
    created  INTEGER NOT NULL,
    finished INTEGER,
    expires  INTEGER,                            -- of the results
    lease    TEXT NOT NULL DEFAULT '',
    document TEXT NOT NULL
);
CREATE INDEX jobs_by_status ON jobs (status, number);
CREATE INDEX jobs_by_shape ON jobs (shape);
CREATE TABLE results (
    job_id TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    name   TEXT NOT NULL,
    type   TEXT NOT NULL,
    bytes  INTEGER NOT NULL,
    sha256 TEXT NOT NULL,
    PRIMARY KEY (job_id, name)
);
CREATE INDEX results_by_digest ON results (sha256);
CREATE TABLE dictionaries (
    number  INTEGER PRIMARY KEY AUTOINCREMENT,
    id      TEXT NOT NULL UNIQUE,
    job_id  TEXT NOT NULL,
    sha256  TEXT NOT NULL,
    created INTEGER NOT NULL,
    expires INTEGER NOT NULL,
    summary TEXT NOT NULL
);
CREATE INDEX dictionaries_by_digest ON dictionaries (sha256);
)sql";

}  // namespace

void create_schema(SqliteDatabase& db) {
    SqlTransaction transaction(db);
    const std::int64_t found = db.user_version();
    if (found > kVersion) {
        throw Error(ErrorCode::StorageFailure,
                    "The data folder was written by a newer lpf-server (schema " +
                        std::to_string(found) + ", this program knows " + std::to_string(kVersion) +
                        "). Start that version instead.");
    }
    if (found == 0) {
        db.script(kTables);
        db.script("PRAGMA user_version = " + std::to_string(kVersion));
    }
    transaction.commit();
}

}  // namespace lpf::server
