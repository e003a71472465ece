#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace lpf {

/// From the code's names to those of the wire: "pattern_points" -> "patternPoints". Names that are
/// camelCase already stay as they are.
[[nodiscard]] inline std::string camel_case(std::string_view snake_case) {
    std::string name;
    bool upper = false;
    for (const char c : snake_case) {
        if (c == '_') {
            upper = true;
            continue;
        }
        name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
        upper = false;
    }
    return name;
}

}  // namespace lpf
