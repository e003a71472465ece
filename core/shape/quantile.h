#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lpf {

/// The value that this share of the values are below, 0 to 1; reorders them. 0 where there are
/// none.
[[nodiscard]] inline double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

[[nodiscard]] inline double median(std::vector<double>& values) { return quantile(values, 0.5); }

}  // namespace lpf
