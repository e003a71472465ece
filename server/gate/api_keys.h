#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lpf::gate {

/// The keys that open the service. Only their SHA-256 is known here, never the keys themselves.
class ApiKeys {
public:
    /// Lines `name:sha256-in-hex`; blank lines and lines that begin with # are skipped. A name may
    /// come more than once, so that a key can be replaced while the old one still opens.
    /// @throws Error{InvalidParameter} that names the line and what would be right
    [[nodiscard]] static ApiKeys parse(std::string_view text);

    /// The name of the key, or nothing. Takes the same time wherever the key differs.
    [[nodiscard]] std::optional<std::string> name_of(std::string_view key) const;

    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// The line of a key file that lets this key in.
    /// @throws Error{InvalidParameter} for a name that is none, or a key that is easily guessed
    [[nodiscard]] static std::string line(const std::string& name, const std::string& key);

private:
    using Digest = std::array<unsigned char, 32>;
    struct Entry {
        std::string name;
        Digest digest;
    };

    [[nodiscard]] static Digest digest_of(std::string_view key);
    [[nodiscard]] static Entry parse_line(std::string_view line, std::size_t number);

    std::vector<Entry> entries_;
};

/// The keys of a file, which may change while the service runs.
class KeyFile {
public:
    /// @throws Error{InvalidParameter} when the file cannot be read or is wrong
    explicit KeyFile(std::filesystem::path path);

    /// Reads the file again. What was read before stays when the file is wrong.
    /// @throws Error{InvalidParameter}
    void reload();

    [[nodiscard]] std::shared_ptr<const ApiKeys> keys() const;

    /// True if others than the owner and the group can read the file.
    [[nodiscard]] bool readable_by_all() const;

private:
    std::filesystem::path path_;
    mutable std::mutex mutex_;
    std::shared_ptr<const ApiKeys> keys_;
};

/// The key of an Authorization header of the kind Bearer (RFC 6750), or nothing.
[[nodiscard]] std::optional<std::string> bearer_key(std::string_view authorization);

}  // namespace lpf::gate
