#include "server/store/sqlite_schema.h"

#include <array>

#include "core/base/error.h"

namespace lpf::server {
namespace {

// Each step leads from one version to the next. A step is never changed once it was shipped.
constexpr const char* kVersion1 = R"sql(
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

// What leases, turns, retries and Idempotency-Keys need. Jobs of version 1 have no lease: those
// that run are taken back at once.
constexpr const char* kVersion2 = R"sql(
ALTER TABLE jobs ADD COLUMN owner       TEXT NOT NULL DEFAULT '';  -- name of the API key
ALTER TABLE jobs ADD COLUMN points      INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN rank        INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN started     INTEGER;
ALTER TABLE jobs ADD COLUMN lease_until INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN retry_of    TEXT;
UPDATE jobs SET rank = created, points = coalesce(
    (SELECT json_extract(shapes.document, '$.points') FROM shapes WHERE shapes.id = jobs.shape), 0);
DROP INDEX jobs_by_status;
CREATE INDEX jobs_by_status ON jobs (status, number, owner, points, rank);
CREATE INDEX jobs_by_origin ON jobs (retry_of) WHERE retry_of IS NOT NULL;
CREATE TABLE turns (
    owner TEXT PRIMARY KEY,
    last  INTEGER NOT NULL                       -- grows with every job that is started
);
CREATE TABLE requests (
    owner       TEXT NOT NULL,
    key         TEXT NOT NULL,                   -- Idempotency-Key
    fingerprint TEXT NOT NULL,
    job_id      TEXT NOT NULL REFERENCES jobs (id) ON DELETE CASCADE,
    PRIMARY KEY (owner, key)
);
CREATE INDEX requests_by_job ON requests (job_id);
)sql";

// What a job may take. That of a job of version 2 is not known, and not waited for.
constexpr const char* kVersion3 = R"sql(
ALTER TABLE jobs ADD COLUMN memory INTEGER NOT NULL DEFAULT 0;     -- bytes
DROP INDEX jobs_by_status;
CREATE INDEX jobs_by_status ON jobs (status, number, owner, points, rank, memory);
)sql";

constexpr std::array kSteps{kVersion1, kVersion2, kVersion3};
constexpr auto kNewest = static_cast<std::int64_t>(kSteps.size());

void require_whole(SqliteDatabase& db) {
    auto rows = db.query("PRAGMA quick_check(1)");
    if (rows.next() && rows.text(0) == "ok") return;
    throw Error(ErrorCode::StorageFailure,
                "The file jobs.sqlite in the data folder is damaged (" + rows.text(0) +
                    "): put back a copy of the data folder, or move it away and start with an "
                    "empty one.");
}

}  // namespace

void create_schema(SqliteDatabase& db) {
    require_whole(db);
    SqlTransaction transaction(db);
    const std::int64_t found = db.user_version();
    if (found > kNewest) {
        throw Error(ErrorCode::StorageFailure,
                    "The data folder was written by a newer lpf-server (schema " +
                        std::to_string(found) + ", this program knows " + std::to_string(kNewest) +
                        "). Start that version instead.");
    }
    for (std::int64_t version = found; version < kNewest; ++version)
        db.script(kSteps[static_cast<std::size_t>(version)]);
    if (found < kNewest) db.script("PRAGMA user_version = " + std::to_string(kNewest));
    transaction.commit();
}

}  // namespace lpf::server
