#include "server/gate/api_keys.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <strings.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "core/base/error.h"

namespace lpf::gate {
namespace {

constexpr std::size_t kLongestName = 64;
constexpr std::size_t kShortestKey = 16;
constexpr std::size_t kLongestKey = 256;
constexpr std::string_view kHexDigits = "0123456789abcdef";

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidParameter, text);
}

bool is_name(std::string_view text) {
    return !text.empty() && text.size() <= kLongestName &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) {
               return std::isalnum(c) || c == '-' || c == '_' || c == '.';
           });
}

/// What a Bearer token may be made of (RFC 6750, Sec. 2.1).
bool is_token(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](unsigned char c) {
        return std::isalnum(c) ||
               std::string_view("-._~+/=").find(static_cast<char>(c)) != std::string_view::npos;
    });
}

std::string_view trim(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r";
    const auto first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::size_t hex_value(char c) {
    return kHexDigits.find(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
}

}  // namespace

ApiKeys::Digest ApiKeys::digest_of(std::string_view key) {
    Digest digest{};
    unsigned int size = 0;
    if (EVP_Digest(key.data(), key.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
        throw Error(ErrorCode::Internal, "SHA-256 failed.");
    return digest;
}

ApiKeys::Entry ApiKeys::parse_line(std::string_view line, std::size_t number) {
    const std::string where = "Line " + std::to_string(number) + " of the API key file: ";
    const auto colon = line.find(':');
    if (colon == std::string_view::npos)
        refuse(where + "it must read name:sha256, as lpf-server --hash-key NAME prints it.");
    const auto name = trim(line.substr(0, colon));
    const auto hex = trim(line.substr(colon + 1));
    if (!is_name(name))
        refuse(where + "a name has 1 to 64 letters, digits, '-', '_' or '.' before the colon.");
    Entry entry{std::string(name), {}};
    bool is_hex = hex.size() == 2 * entry.digest.size();
    for (std::size_t i = 0; is_hex && i < entry.digest.size(); ++i) {
        const auto high = hex_value(hex[2 * i]);
        const auto low = hex_value(hex[2 * i + 1]);
        is_hex = high < 16 && low < 16;
        entry.digest[i] = static_cast<unsigned char>(high * 16 + low);
    }
    // The text after the colon is not shown: somebody may have put the key itself there.
    if (!is_hex) refuse(where + "after the colon there must be the 64 hex digits of a SHA-256.");
    return entry;
}

ApiKeys ApiKeys::parse(std::string_view text) {
    ApiKeys keys;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const auto end = std::min(text.find('\n'), text.size());
        const auto line = trim(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.empty() || line.starts_with('#')) continue;
        Entry entry = parse_line(line, number);
        for (const Entry& other : keys.entries_) {
            if (other.digest != entry.digest) continue;
            refuse("Line " + std::to_string(number) +
                   " of the API key file: the same key has the name '" + other.name +
                   "' further up; a key has one name.");
        }
        keys.entries_.push_back(std::move(entry));
    }
    if (keys.entries_.empty())
        refuse("The API key file holds no key. Add a line with lpf-server --hash-key NAME.");
    return keys;
}

std::optional<std::string> ApiKeys::name_of(std::string_view key) const {
    const Digest shown = digest_of(key);
    const Entry* found = nullptr;
    for (const Entry& entry : entries_) {  // all of them: the time tells nothing
        if (CRYPTO_memcmp(shown.data(), entry.digest.data(), shown.size()) == 0) found = &entry;
    }
    if (!found) return std::nullopt;
    return found->name;
}

std::string ApiKeys::line(const std::string& name, const std::string& key) {
    if (!is_name(name)) refuse("A name has 1 to 64 letters, digits, '-', '_' or '.'.");
    if (key.size() < kShortestKey || key.size() > kLongestKey || !is_token(key)) {
        refuse(
            "A key has 16 to 256 letters, digits or any of -._~+/= and should be random, such as "
            "what 'openssl rand -hex 32' prints.");
    }
    std::string text = name + ":";
    for (const unsigned char byte : digest_of(key)) {
        text += kHexDigits[byte >> 4];
        text += kHexDigits[byte & 15];
    }
    return text;
}

KeyFile::KeyFile(std::filesystem::path path) : path_(std::move(path)) { reload(); }

void KeyFile::reload() {
    std::ifstream file(path_, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file.is_open() || file.bad()) {
        refuse("The API key file " + path_.string() +
               " cannot be read. Name a file that this user may read with --api-key-file.");
    }
    auto keys = std::make_shared<const ApiKeys>(ApiKeys::parse(text));
    const std::lock_guard lock(mutex_);
    keys_ = std::move(keys);
}

std::shared_ptr<const ApiKeys> KeyFile::keys() const {
    const std::lock_guard lock(mutex_);
    return keys_;
}

bool KeyFile::readable_by_all() const {
    std::error_code ignored;
    const auto permissions = std::filesystem::status(path_, ignored).permissions();
    return permissions != std::filesystem::perms::unknown &&
           (permissions & std::filesystem::perms::others_read) != std::filesystem::perms::none;
}

std::optional<std::string> bearer_key(std::string_view authorization) {
    constexpr std::string_view kScheme = "bearer ";
    if (authorization.size() <= kScheme.size() ||
        ::strncasecmp(authorization.data(), kScheme.data(), kScheme.size()) != 0)
        return std::nullopt;
    const auto key = trim(authorization.substr(kScheme.size()));
    if (key.empty()) return std::nullopt;
    return std::string(key);
}

}  // namespace lpf::gate
