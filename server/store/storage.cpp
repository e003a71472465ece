#include "server/store/storage.h"

#include <utility>

namespace lpf::server {
namespace {

constexpr auto kUnknownAge = std::chrono::hours(1);

}  // namespace

FileHold& FileHold::operator=(FileHold&& other) noexcept {
    if (this == &other) return *this;
    release();
    storage_ = std::exchange(other.storage_, nullptr);
    digests_ = std::exchange(other.digests_, {});
    return *this;
}

std::string FileHold::commit(BlobWriter& writer) {
    const std::string digest = writer.digest();
    {
        const std::lock_guard lock(storage_->mutex_);
        storage_->held_.insert(digest);
        digests_.push_back(digest);
    }
    return writer.commit();
}

void FileHold::release() {
    if (!storage_ || digests_.empty()) return;
    const std::lock_guard lock(storage_->mutex_);
    for (const std::string& digest : digests_) storage_->held_.erase(storage_->held_.find(digest));
    digests_.clear();
}

void Storage::remove_if_unknown(const std::string& digest) {
    const std::lock_guard lock(mutex_);
    if (!held_.contains(digest) && !jobs_.refers_to(digest)) blobs_.remove(digest);
}

void Storage::forget(const std::vector<std::string>& digests) {
    for (const std::string& digest : digests) remove_if_unknown(digest);
}

std::size_t Storage::sweep(UnixMillis now, UnixMillis status_retention) {
    const auto before = jobs_.all_digests();
    std::size_t removed = jobs_.remove_expired(now, status_retention);
    const auto after = jobs_.all_digests();
    for (const std::string& digest : before)
        if (!after.contains(digest)) remove_if_unknown(digest);
    // Under the lock nobody begins to add a file; what was begun before is held or in the books.
    const std::lock_guard lock(mutex_);
    const auto known = jobs_.all_digests();
    const auto is_known = [&](const std::string& digest) {
        return known.contains(digest) || held_.contains(digest) || jobs_.refers_to(digest);
    };
    return removed + blobs_.quarantine_unknown(is_known, kUnknownAge);
}

}  // namespace lpf::server
