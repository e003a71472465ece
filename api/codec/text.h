#pragma once

#include <locale>
#include <sstream>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace lpf {

/// 'text' in quotes as it may be shown in a message: shortened, unprintable bytes as \xNN.
[[nodiscard]] std::string quoted(std::string_view text);

/// One message of pieces, the same in every locale.
template <typename... Parts>
[[nodiscard]] std::string message_of(const Parts&... parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    (out << ... << parts);
    return out.str();
}

template <typename... Parts>
[[noreturn]] void fail(ErrorCode code, const Parts&... parts) {
    throw Error(code, message_of(parts...));
}

template <typename... Parts>
[[noreturn]] void malformed(const Parts&... parts) {
    fail(ErrorCode::MalformedFile, parts...);
}

}  // namespace lpf
