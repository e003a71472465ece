#include "server/store/data_dir.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "api/problem.h"
#include "core/base/error.h"

namespace lpf::server {

DataDir::DataDir(std::filesystem::path path) : path_(std::move(path)) {
    std::error_code error;
    std::filesystem::create_directories(path_, error);
    const auto lock_file = path_ / "lock";
    if (!error) lock_ = ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (lock_ < 0) {
        const std::string why = error ? error.message() : std::strerror(errno);
        throw Error(ErrorCode::StorageFailure,
                    "The data folder " + path_.string() + " cannot be written to (" + why +
                        "). Name a folder that this user may write to with --data-dir.");
    }
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
        ::close(lock_);
        throw Error(ErrorCode::StorageFailure,
                    "The data folder " + path_.string() +
                        " is in use by another server. Stop it, or name another folder with "
                        "--data-dir.");
    }
}

DataDir::~DataDir() { ::close(lock_); }

void DataDir::require_space(std::uint64_t bytes, const Limits& limits) const {
    std::error_code error;
    const auto space = std::filesystem::space(path_, error);
    if (error) return;
    const std::uint64_t share = space.capacity / 100 * limits.disk_floor_percent;
    const std::uint64_t floor = std::min<std::uint64_t>(
        std::max<std::uint64_t>(share, limits.disk_floor_bytes), space.capacity / 2);
    if (space.available < floor || space.available - floor < bytes) {
        throw ProblemException(ProblemCode::InsufficientStorage,
                               "The server's disk is nearly full; try again later, or delete "
                               "shapes and jobs that are no longer needed.");
    }
}

}  // namespace lpf::server
