#include "api/codec/memory_file.h"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "api/codec/text.h"

namespace lpf {

MemoryFile::MemoryFile() : descriptor_(memfd_create("lpf-helper", MFD_CLOEXEC)) {
    if (descriptor_ < 0) fail(ErrorCode::Internal, "memfd_create: ", std::strerror(errno));
}

MemoryFile::~MemoryFile() {
    if (mapping_ != nullptr) munmap(mapping_, size_);
    close(descriptor_);
}

void MemoryFile::write_all(std::span<const std::byte> bytes, const Execution& execution) {
    constexpr std::size_t kPiece = 16U << 20U;
    while (!bytes.empty()) {
        throw_if_cancelled(execution);
        const ssize_t written = write(descriptor_, bytes.data(), std::min(bytes.size(), kPiece));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail(ErrorCode::OutOfMemory, "memfd: ", std::strerror(errno));
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    lseek(descriptor_, 0, SEEK_SET);
}

std::span<const std::byte> MemoryFile::map() {
    struct stat status {};
    if (fstat(descriptor_, &status) != 0 || status.st_size == 0) return {};
    size_ = static_cast<std::size_t>(status.st_size);
    void* const mapping = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
    if (mapping == MAP_FAILED) fail(ErrorCode::OutOfMemory, "mmap: ", std::strerror(errno));
    mapping_ = mapping;
    return {static_cast<const std::byte*>(mapping_), size_};
}

void MemoryFile::let_go(std::size_t bytes) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    if (mapping_ != nullptr) madvise(mapping_, bytes / page * page, MADV_DONTNEED);
}

}  // namespace lpf
