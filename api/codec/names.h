#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace lpf {

/// Names of columns that are safe in a PLY header and different from each other.
class NameSet {
public:
    /// @param taken  names that are in use already
    explicit NameSet(std::set<std::string, std::less<>> taken) : taken_(std::move(taken)) {}

    /// `wanted`, with blanks and control characters made '_', and _2, _3, ... put behind it if it
    /// is taken already.
    [[nodiscard]] std::string claim(std::string_view wanted);

private:
    std::set<std::string, std::less<>> taken_;
};

/// A comment as one header line: line ends and NUL become blanks.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace lpf
