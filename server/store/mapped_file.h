#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace lpf::server {

/// A file as read-only memory.
class MappedFile {
public:
    /// @throws Error{StorageFailure}
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;

    [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }
    [[nodiscard]] std::string_view text() const {
        return {reinterpret_cast<const char*>(data_), size_};
    }

    /// Takes the first bytes out of memory; they are read again from the disk if need be.
    void let_go(std::size_t bytes) const;

private:
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace lpf::server
