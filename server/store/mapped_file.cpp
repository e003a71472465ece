#include "server/store/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"

namespace lpf::server {

MappedFile::MappedFile(const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (file < 0 || ::fstat(file, &status) != 0) {
        if (file >= 0) ::close(file);
        throw Error(ErrorCode::StorageFailure, "A stored file cannot be opened.");
    }
    size_ = static_cast<std::size_t>(status.st_size);
    void* memory = size_ ? ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0) : nullptr;
    ::close(file);
    if (memory == MAP_FAILED)
        throw Error(ErrorCode::StorageFailure, "A stored file cannot be mapped into memory.");
    data_ = static_cast<const std::byte*>(memory);
}

MappedFile::~MappedFile() {
    if (data_) ::munmap(const_cast<std::byte*>(data_), size_);
}

void MappedFile::let_go(std::size_t bytes) const {
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    if (data_) ::madvise(const_cast<std::byte*>(data_), bytes / page * page, MADV_DONTNEED);
}

}  // namespace lpf::server
