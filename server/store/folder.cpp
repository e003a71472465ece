#include "server/store/folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"

namespace lpf::server {

void sync_folder(const std::filesystem::path& folder) {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const int result = file < 0 ? -1 : ::fsync(file);
    const int error = errno;
    if (file >= 0) ::close(file);
    if (result != 0) {
        throw Error(
            ErrorCode::StorageFailure,
            "The folder " + folder.string() + " cannot be synced: " + std::strerror(error) + ".");
    }
}

}  // namespace lpf::server
