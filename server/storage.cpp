#include "server/storage.h"

#include <mutex>
#include <set>

namespace lpf::server {
namespace {

constexpr auto kUnknownAge = std::chrono::hours(1);

}  // namespace

void Storage::forget(const std::vector<std::string>& digests) {
    const std::unique_lock lock(mutex_);
    for (const std::string& digest : digests)
        if (!jobs_.refers_to(digest)) blobs_.remove(digest);
}

std::size_t Storage::sweep(UnixMillis now, UnixMillis status_retention) {
    const std::unique_lock lock(mutex_);
    const auto before = jobs_.all_digests();
    std::size_t removed = jobs_.remove_expired(now, status_retention);
    const auto after = jobs_.all_digests();
    for (const std::string& digest : before)
        if (!after.contains(digest)) blobs_.remove(digest);
    return removed +
           blobs_.quarantine_unknown(
               [&](const std::string& digest) { return after.contains(digest); }, kUnknownAge);
}

}  // namespace lpf::server
