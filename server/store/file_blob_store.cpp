#include "server/store/file_blob_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "api/problem.h"
#include "core/base/error.h"
#include "server/ids.h"
#include "server/store/folder.h"
#include "server/store/sha256.h"

namespace lpf::server {
namespace fs = std::filesystem;
namespace {

constexpr auto kQuarantineTime = std::chrono::hours(24);

[[noreturn]] void fail(const std::string& what) {
    if (errno == ENOSPC || errno == EDQUOT) {
        throw ProblemException(ProblemCode::InsufficientStorage,
                               "The server's disk is full; try again later.");
    }
    throw Error(ErrorCode::StorageFailure, what + ": " + std::strerror(errno) + ".");
}

class FileBlobWriter : public BlobWriter {
public:
    explicit FileBlobWriter(FileBlobStore& store)
        : store_(store), path_(store.root() / "tmp" / new_id()) {
        file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
        if (file_ < 0) fail("A temporary file cannot be made");
    }

    ~FileBlobWriter() override {
        if (file_ >= 0) ::close(file_);
        if (!path_.empty()) ::unlink(path_.c_str());
    }

    FileBlobWriter(const FileBlobWriter&) = delete;
    FileBlobWriter& operator=(const FileBlobWriter&) = delete;

    void write(std::string_view bytes) override {
        hash_.update(bytes);
        size_ += bytes.size();
        while (!bytes.empty()) {
            const auto n = ::write(file_, bytes.data(), bytes.size());
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) fail("Writing to the data folder failed");
            bytes.remove_prefix(static_cast<std::size_t>(n));
        }
    }

    [[nodiscard]] std::uint64_t size() const override { return size_; }
    [[nodiscard]] fs::path staged() override { return path_; }

    [[nodiscard]] std::string digest() override {
        if (digest_.empty()) digest_ = hash_.finish();
        return digest_;
    }

    std::string commit() override {
        if (::fsync(file_) != 0) fail("Syncing a file failed");
        ::close(file_);
        file_ = -1;
        store_.take_in(path_, digest(), size_);
        path_.clear();
        return digest_;
    }

private:
    FileBlobStore& store_;
    fs::path path_;
    int file_ = -1;
    std::uint64_t size_ = 0;
    Sha256 hash_;
    std::string digest_;  // once it was asked for
};

std::vector<fs::path> files_below(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
}

/// 0 if it is not there.
std::uint64_t bytes_of(const fs::path& file) {
    std::error_code error;
    const auto bytes = fs::file_size(file, error);
    return error ? 0 : bytes;
}

bool is_older(const fs::path& file, std::chrono::seconds age) {
    std::error_code error;
    const auto time = fs::last_write_time(file, error);
    return !error && time + age < fs::file_time_type::clock::now();
}

}  // namespace

FileBlobStore::FileBlobStore(fs::path root) : root_(std::move(root)) {
    make_folders();
    std::error_code error;
    for (const auto& file : files_below(root_ / "tmp")) fs::remove(file, error);
    for (const auto& file : files_below(root_ / "blobs")) stored_bytes_ += bytes_of(file);
}

void FileBlobStore::make_folders() const {
    for (const char* name : {"tmp", "quarantine", "blobs"}) {
        std::error_code error;
        fs::create_directories(root_ / name, error);
        if (error) {
            throw Error(ErrorCode::StorageFailure,
                        "The folder '" + std::string(name) +
                            "' of the data folder cannot be made: " + error.message() + ".");
        }
    }
    // Also what a run before may have made without living to see it durable.
    sync_folder(root_ / "blobs");
    sync_folder(root_);
    sync_folder(fs::absolute(root_).parent_path());
}

std::unique_ptr<BlobWriter> FileBlobStore::create() {
    return std::make_unique<FileBlobWriter>(*this);
}

void FileBlobStore::take_in(const fs::path& file, const std::string& digest, std::uint64_t bytes) {
    const fs::path place = path_of(digest);
    {
        const std::lock_guard lock(mutex_);
        // Nobody puts a file into a folder that a crash could still take away.
        if (::mkdir(place.parent_path().c_str(), 0700) == 0) {
            sync_folder(root_ / "blobs");
        } else if (errno != EEXIST) {
            fail("A folder for a file cannot be made");
        }
        const std::uint64_t before = bytes_of(place);
        if (::rename(file.c_str(), place.c_str()) != 0) fail("Moving a file to its place failed");
        stored_bytes_ += bytes - before;  // of equal files only one is kept
    }
    sync_folder(place.parent_path());
}

fs::path FileBlobStore::path_of(const std::string& digest) const {
    if (!is_sha256(digest))
        throw Error(ErrorCode::Internal, "A blob was asked for by a wrong name.");
    return root_ / "blobs" / digest.substr(0, 2) / digest;
}

std::optional<std::uint64_t> FileBlobStore::size(const std::string& digest) const {
    std::error_code error;
    const auto bytes = fs::file_size(path_of(digest), error);
    return error ? std::nullopt : std::optional<std::uint64_t>(bytes);
}

fs::path FileBlobStore::local_file(const std::string& digest) const {
    fs::path path = path_of(digest);
    if (!fs::exists(path))
        throw Error(ErrorCode::StorageFailure, "A stored file is missing from the data folder.");
    return path;
}

std::uint64_t FileBlobStore::stored_bytes() const {
    const std::lock_guard lock(mutex_);
    return stored_bytes_;
}

void FileBlobStore::remove(const std::string& digest) {
    const fs::path file = path_of(digest);
    const std::lock_guard lock(mutex_);
    const std::uint64_t bytes = bytes_of(file);
    std::error_code error;
    if (fs::remove(file, error) && !error) stored_bytes_ -= bytes;
}

std::size_t FileBlobStore::quarantine_unknown(
    const std::function<bool(const std::string&)>& is_known, std::chrono::seconds age) {
    empty_quarantine();
    std::size_t moved = 0;
    for (const auto& file : files_below(root_ / "blobs")) {
        const std::string name = file.filename();
        if ((is_sha256(name) && is_known(name)) || !is_older(file, age)) continue;
        const std::lock_guard lock(mutex_);
        const std::uint64_t bytes = bytes_of(file);
        std::error_code error;
        const fs::path aside = root_ / "quarantine" / name;
        fs::rename(file, aside, error);
        if (error) continue;
        stored_bytes_ -= bytes;
        ++moved;
        fs::last_write_time(aside, fs::file_time_type::clock::now(), error);
    }
    return moved;
}

void FileBlobStore::empty_quarantine() {
    std::error_code error;
    for (const auto& file : files_below(root_ / "quarantine"))
        if (is_older(file, kQuarantineTime)) fs::remove(file, error);
}

}  // namespace lpf::server
