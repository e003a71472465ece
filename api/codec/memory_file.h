#pragma once

#include <cstddef>
#include <span>

#include "core/base/parallel.h"

namespace lpf {

/// A file without a name that lives in memory until it is closed, to pass data to a helper process
/// and back without pipes, which could block.
class MemoryFile {
public:
    /// @throws Error{Internal}
    MemoryFile();
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] int descriptor() const { return descriptor_; }

    /// @throws Error{OutOfMemory, Cancelled}
    void write_all(std::span<const std::byte> bytes, const Execution& execution);

    /// The whole content; valid as long as this object. @throws Error{OutOfMemory}
    [[nodiscard]] std::span<const std::byte> map();

    /// Takes the first bytes of what was mapped out of this process' memory; they stay readable.
    void let_go(std::size_t bytes);

private:
    int descriptor_;
    void* mapping_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lpf
