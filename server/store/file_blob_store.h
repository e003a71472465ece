#pragma once

#include <mutex>

#include "server/blob_store.h"

namespace lpf::server {

/// Blobs as files `blobs/ab/<sha256>` of one folder. A blob is written to `tmp/`, synced, renamed
/// and its folder synced: after a crash it is there as a whole or not at all.
class FileBlobStore : public BlobStore {
public:
    /// Makes the folders, counts what is there, and empties `tmp/` of what a crash left there.
    /// @throws Error{StorageFailure}
    explicit FileBlobStore(std::filesystem::path root);

    [[nodiscard]] std::unique_ptr<BlobWriter> create() override;
    [[nodiscard]] std::optional<std::uint64_t> size(const std::string& digest) const override;
    [[nodiscard]] std::filesystem::path local_file(const std::string& digest) const override;
    [[nodiscard]] std::uint64_t stored_bytes() const override;
    void remove(const std::string& digest) override;
    std::size_t quarantine_unknown(const std::function<bool(const std::string&)>& is_known,
                                   std::chrono::seconds age) override;

    [[nodiscard]] const std::filesystem::path& root() const { return root_; }

    /// Moves a finished and synced file below `tmp/` to its place. For the writers.
    void take_in(const std::filesystem::path& file, const std::string& digest, std::uint64_t bytes);

private:
    void make_folders() const;
    [[nodiscard]] std::filesystem::path path_of(const std::string& digest) const;
    void empty_quarantine();

    std::filesystem::path root_;
    mutable std::mutex mutex_;        // moves of files, with the count of their bytes
    std::uint64_t stored_bytes_ = 0;  // below blobs/
};

}  // namespace lpf::server
