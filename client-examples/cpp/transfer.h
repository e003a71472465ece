#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

namespace lpf_client {

/// A file to upload, read piece by piece.
class Upload {
public:
    explicit Upload(const std::string& path);
    std::uint64_t size() const { return size_; }

    /// The bytes from `offset` on, `length` at most; empty if they cannot be read.
    std::string read(std::uint64_t offset, std::uint64_t length);

private:
    std::ifstream file_;
    std::uint64_t size_ = 0;
};

/// A result on its way to the disk: takes the place of `path` once it is complete and checked.
class Download {
public:
    explicit Download(std::string path);
    ~Download();  ///< removes what was not kept
    Download(const Download&) = delete;
    Download& operator=(const Download&) = delete;

    void restart();
    void write(const char* data, std::size_t size);
    std::uint64_t size() const { return size_; }

    /// Shows the file under its name if what came has this SHA-256 (hexadecimal).
    void keep(const std::string& sha256);

private:
    struct Hash;

    std::string path_;
    std::string part_;
    std::ofstream file_;
    std::unique_ptr<Hash> hash_;
    std::uint64_t size_ = 0;
};

}  // namespace lpf_client
