#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace lpf::server {

/// Bytes on their way into a store. Nothing is kept unless commit() was called.
class BlobWriter {
public:
    virtual ~BlobWriter() = default;

    /// @throws Error{StorageFailure}
    virtual void write(std::string_view bytes) = 0;
    [[nodiscard]] virtual std::uint64_t size() const = 0;

    /// A local file with the bytes written so far, to look at before they are kept.
    [[nodiscard]] virtual std::filesystem::path staged() = 0;

    /// SHA-256 of the bytes. Nothing may be written after it was asked for.
    [[nodiscard]] virtual std::string digest() = 0;

    /// Makes the bytes durable under their SHA-256. Call once. @throws Error{StorageFailure}
    /// @returns the digest
    virtual std::string commit() = 0;
};

/// Files that are found by their content: the SHA-256 of a blob is its name, so that equal files
/// are kept once and a name never changes its meaning.
class BlobStore {
public:
    virtual ~BlobStore() = default;

    /// @throws Error{StorageFailure}
    [[nodiscard]] virtual std::unique_ptr<BlobWriter> create() = 0;

    /// Writes and commits in one go. @returns the digest
    std::string put(std::string_view bytes) {
        const auto writer = create();
        writer->write(bytes);
        return writer->commit();
    }

    /// Bytes of the blob, or nothing if it is not here.
    [[nodiscard]] virtual std::optional<std::uint64_t> size(const std::string& digest) const = 0;

    /// A local file that holds the blob (a store over a network fetches it into a cache).
    /// @throws Error{StorageFailure} if the blob is not here
    [[nodiscard]] virtual std::filesystem::path local_file(const std::string& digest) const = 0;

    /// Bytes of all blobs, without those that were put aside.
    [[nodiscard]] virtual std::uint64_t stored_bytes() const = 0;

    /// Deletes a blob; nothing happens if it is not here.
    virtual void remove(const std::string& digest) = 0;

    /// Puts aside blobs that nobody knows (`is_known` false) and that are older than `age`, and
    /// deletes what was put aside a day ago: a mistake in the books must not cost data at once.
    /// @returns number of blobs put aside
    virtual std::size_t quarantine_unknown(const std::function<bool(const std::string&)>& is_known,
                                           std::chrono::seconds age) = 0;
};

}  // namespace lpf::server
