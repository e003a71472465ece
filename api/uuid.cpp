#include "api/uuid.h"

#include <cstddef>

namespace lpf {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

bool is_dash(std::size_t i) { return i == 8 || i == 13 || i == 18 || i == 23; }

}  // namespace

std::string make_uuid7(std::int64_t unix_millis, const std::array<std::uint8_t, 10>& random) {
    std::array<std::uint8_t, 16> bytes{};
    const auto time = static_cast<std::uint64_t>(unix_millis);
    for (std::size_t i = 0; i < 6; ++i) {
        bytes[i] = static_cast<std::uint8_t>(time >> (8 * (5 - i)));
    }
    for (std::size_t i = 0; i < random.size(); ++i) bytes[6 + i] = random[i];
    bytes[6] = static_cast<std::uint8_t>((bytes[6] & 0x0F) | 0x70);  // version 7
    bytes[8] = static_cast<std::uint8_t>((bytes[8] & 0x3F) | 0x80);  // variant of RFC 9562
    std::string text;
    for (const std::uint8_t byte : bytes) {
        if (is_dash(text.size())) text += '-';
        text += kDigits[byte >> 4];
        text += kDigits[byte & 15];
    }
    return text;
}

bool is_uuid7(std::string_view text) {
    if (text.size() != 36) return false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool fits =
            is_dash(i) ? text[i] == '-' : kDigits.find(text[i]) != std::string_view::npos;
        if (!fits) return false;
    }
    return text[14] == '7' && std::string_view("89ab").find(text[19]) != std::string_view::npos;
}

std::int64_t uuid7_millis(std::string_view text) {
    std::int64_t millis = 0;
    for (const char c : text.substr(0, 13)) {
        if (c != '-') millis = millis * 16 + static_cast<std::int64_t>(kDigits.find(c));
    }
    return millis;
}

}  // namespace lpf
