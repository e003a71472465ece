#pragma once

#include <shared_mutex>
#include <vector>

#include "server/blob_store.h"
#include "server/job_store.h"

namespace lpf::server {

/// The books and the files together. A blob is written before the books name it, and must not be
/// swept away in between: whoever does both holds `adding()` meanwhile.
class Storage {
public:
    Storage(JobStore& jobs, BlobStore& blobs) : jobs_(jobs), blobs_(blobs) {}

    [[nodiscard]] JobStore& jobs() { return jobs_; }
    [[nodiscard]] BlobStore& blobs() { return blobs_; }

    /// Held from the commit of a blob until the books name it.
    [[nodiscard]] std::shared_lock<std::shared_mutex> adding() { return std::shared_lock(mutex_); }

    /// Deletes those of the blobs that the books no longer name.
    void forget(const std::vector<std::string>& digests);

    /// Removes what has expired, with its files, and puts files aside that nobody knows.
    /// @returns records and files removed
    std::size_t sweep(UnixMillis now, UnixMillis status_retention);

private:
    JobStore& jobs_;
    BlobStore& blobs_;
    std::shared_mutex mutex_;
};

}  // namespace lpf::server
