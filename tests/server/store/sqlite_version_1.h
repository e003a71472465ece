#pragma once

namespace lpf::server {

/// What a server of schema version 1 left: a shape, and jobs that wait, run and ended.
inline constexpr const char* kVersion1Database = R"sql(
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

INSERT INTO shapes VALUES ('0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3',
    '2cf24dba5fb0a30e26e83b2ac5b9e29e1b161e5c1fa7425e73043362938b9824', 1900000000000,
    '{"id":"0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3","format":"ply","bytes":5,
      "sha256":"2cf24dba5fb0a30e26e83b2ac5b9e29e1b161e5c1fa7425e73043362938b9824",
      "points":4321,"faces":0,"attributes":[],"created":"2027-01-15T08:00:00.000Z",
      "expires":"2030-03-17T17:46:40.000Z","warnings":[],"links":[]}');
INSERT INTO jobs (id, process, status, shape, created, lease, document) VALUES (
    '0198f3a2-7c1e-7d42-9b57-000000000001', 'denoise', 'running',
    '0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3', 1800000000000, 'token',
    '{"jobID":"0198f3a2-7c1e-7d42-9b57-000000000001","id":"0198f3a2-7c1e-7d42-9b57-000000000001",
      "processID":"denoise","type":"process","status":"running","message":"Running.","progress":40,
      "created":"2027-01-15T08:00:00.000Z","updated":"2027-01-15T08:00:01.000Z",
      "started":"2027-01-15T08:00:00.500Z","attempt":1,"parameters":{"radius":2.5},
      "resolvedParameters":{},"shape":"0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3","warnings":[],
      "links":[]}');
INSERT INTO jobs (id, process, status, shape, created, document) VALUES (
    '0198f3a2-7c1e-7d42-9b57-000000000002', 'resample', 'accepted',
    '0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3', 1800000001000,
    '{"jobID":"0198f3a2-7c1e-7d42-9b57-000000000002","id":"0198f3a2-7c1e-7d42-9b57-000000000002",
      "processID":"resample","type":"process","status":"accepted",
      "message":"Waiting for a worker.","progress":0,"created":"2027-01-15T08:00:01.000Z",
      "updated":"2027-01-15T08:00:01.000Z","attempt":0,"parameters":{},"resolvedParameters":{},
      "shape":"0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3","warnings":[],"links":[]}');
INSERT INTO jobs (id, process, status, shape, created, finished, expires, document) VALUES (
    '0198f3a2-7c1e-7d42-9b57-000000000003', 'analyze', 'successful',
    '0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3', 1799999990000, 1799999995000, 1900000000000,
    '{"jobID":"0198f3a2-7c1e-7d42-9b57-000000000003","id":"0198f3a2-7c1e-7d42-9b57-000000000003",
      "processID":"analyze","type":"process","status":"successful","message":"Done.",
      "progress":100,"created":"2027-01-15T07:59:50.000Z","updated":"2027-01-15T07:59:55.000Z",
      "started":"2027-01-15T07:59:51.000Z","finished":"2027-01-15T07:59:55.000Z",
      "expires":"2030-03-17T17:46:40.000Z","attempt":1,"parameters":{},"resolvedParameters":{},
      "shape":"0198f3a2-7b90-7a11-8c3e-5d7f90b1c2d3","warnings":[],"links":[]}');
INSERT INTO results VALUES ('0198f3a2-7c1e-7d42-9b57-000000000003', 'report', 'application/json',
    6, '9ffbf43126e33be52cd2bf7e01d627f9d474f3e58b2de8b8cfde45e0fa5d4a9f');
PRAGMA user_version = 1;
)sql";

}  // namespace lpf::server
