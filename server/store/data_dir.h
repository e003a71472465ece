#pragma once

#include <cstdint>
#include <filesystem>

#include "api/limits.h"

namespace lpf::server {

/// The one folder that the server writes to, locked for as long as this lives: two servers on the
/// same folder would run the same jobs.
class DataDir {
public:
    /// Makes the folder if need be, checks that it can be written to, and locks it.
    /// @throws Error{StorageFailure} that says what to do
    explicit DataDir(std::filesystem::path path);
    ~DataDir();
    DataDir(const DataDir&) = delete;
    DataDir& operator=(const DataDir&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// @throws ProblemException{InsufficientStorage} if storing `bytes` would leave less free space
    ///         than the floor of the limits
    void require_space(std::uint64_t bytes, const Limits& limits) const;

private:
    std::filesystem::path path_;
    int lock_ = -1;
};

}  // namespace lpf::server
