#include "server/requests/preview_cache.h"

#include <algorithm>
#include <fstream>
#include <system_error>
#include <vector>

namespace lpf::server {
namespace {

namespace fs = std::filesystem;

constexpr auto kInUse = std::chrono::minutes(1);  // longer than it takes to open a file

struct Entry {
    fs::path path;
    std::uint64_t bytes = 0;
    fs::file_time_type used;
};

std::vector<Entry> entries_of(const fs::path& folder) {
    std::vector<Entry> entries;
    std::error_code ignored;
    for (const auto& file : fs::directory_iterator(folder, ignored))
        entries.push_back({file.path(), file.file_size(ignored), file.last_write_time(ignored)});
    std::ranges::sort(entries, {}, &Entry::used);
    return entries;
}

}  // namespace

PreviewCache::PreviewCache(fs::path folder, std::uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::create_directories(folder_, ignored);
}

std::optional<fs::path> PreviewCache::find(const std::string& name) {
    const std::lock_guard lock(mutex_);
    const fs::path path = folder_ / name;
    std::error_code missing;
    fs::last_write_time(path, fs::file_time_type::clock::now(), missing);
    if (missing) return std::nullopt;
    return path;
}

bool PreviewCache::keep(const std::string& name, std::string_view bytes) {
    const std::lock_guard lock(mutex_);
    if (bytes.size() > most_bytes_) return false;
    make_room(bytes.size());
    const fs::path path = folder_ / name;
    fs::path unfinished = path;
    unfinished += ".new";
    std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    std::error_code failed;
    if (file) fs::rename(unfinished, path, failed);
    if (file && !failed) return true;
    fs::remove(unfinished, failed);
    return false;
}

void PreviewCache::make_room(std::uint64_t bytes) {
    std::uint64_t total = bytes;
    const auto entries = entries_of(folder_);
    for (const Entry& entry : entries) total += entry.bytes;
    const auto idle_since = fs::file_time_type::clock::now() - kInUse;
    std::error_code ignored;
    for (const Entry& entry : entries) {
        if (total <= most_bytes_ || entry.used > idle_since) return;
        if (fs::remove(entry.path, ignored)) total -= entry.bytes;
    }
}

}  // namespace lpf::server
