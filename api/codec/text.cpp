#include "api/codec/text.h"

#include <cstddef>

namespace lpf {

std::string quoted(std::string_view text) {
    constexpr std::size_t kShown = 40;
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string result = "'";
    for (const char c : text.substr(0, kShown)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f) {
            result += c;
        } else {
            result += "\\x";
            result += kDigits[byte >> 4];
            result += kDigits[byte & 15];
        }
    }
    result += text.size() > kShown ? "...'" : "'";
    return result;
}

}  // namespace lpf
