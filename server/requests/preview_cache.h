#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/clock.h"

namespace lpf::server {

/// Previews that were made before, as files that may go at any time: the least used ones first,
/// when all together are too large, and all of them at the next start.
class PreviewCache {
public:
    /// @param folder is emptied; without one that can be written to, nothing is kept
    explicit PreviewCache(std::filesystem::path folder, std::uint64_t most_bytes = kMostBytes);

    /// The file of a preview, which stays for a minute at least. Nothing if it is not here.
    [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& name);

    /// Keeps a preview. @returns false if that was not possible, which harms nobody
    bool keep(const std::string& name, std::string_view bytes);

    static constexpr std::uint64_t kMostBytes = 256ULL << 20;

private:
    void make_room(std::uint64_t bytes);

    std::filesystem::path folder_;
    std::uint64_t most_bytes_;
    std::mutex mutex_;
};

}  // namespace lpf::server
