#pragma once

#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "server/blob_store.h"
#include "server/job_store.h"

namespace lpf::server {

class Storage;

/// Files that are being added: while this lives they are not swept away, although the books do not
/// name them yet.
class FileHold {
public:
    FileHold() = default;
    explicit FileHold(Storage& storage) : storage_(&storage) {}
    ~FileHold() { release(); }
    FileHold(FileHold&& other) noexcept { *this = std::move(other); }
    FileHold& operator=(FileHold&& other) noexcept;

    /// Makes the bytes of a writer durable, and holds them. @returns the digest
    std::string commit(BlobWriter& writer);

private:
    void release();

    Storage* storage_ = nullptr;
    std::vector<std::string> digests_;
};

/// The books and the files together. A blob is written before the books name it, and must not be
/// swept away in between: whoever does both holds it meanwhile.
class Storage {
public:
    Storage(JobStore& jobs, BlobStore& blobs) : jobs_(jobs), blobs_(blobs) {}

    [[nodiscard]] JobStore& jobs() { return jobs_; }
    [[nodiscard]] BlobStore& blobs() { return blobs_; }

    /// Deletes those of the blobs that the books no longer name.
    void forget(const std::vector<std::string>& digests);

    /// Removes what has expired, with its files, and puts files aside that nobody knows.
    /// @returns records and files removed
    std::size_t sweep(UnixMillis now, UnixMillis status_retention);

private:
    friend class FileHold;
    void remove_if_unknown(const std::string& digest);

    JobStore& jobs_;
    BlobStore& blobs_;
    std::mutex mutex_;  // a file is either being held or being removed
    std::multiset<std::string> held_;
};

}  // namespace lpf::server
