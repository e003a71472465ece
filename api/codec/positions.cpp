#include "api/codec/positions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lpf {

std::vector<float> float_positions(const Points& points) {
    std::vector<float> values(static_cast<std::size_t>(points.size()));
    std::transform(points.data(), points.data() + points.size(), values.begin(),
                   [](double value) { return static_cast<float>(value); });
    return values;
}

double rounding_of(const Points& points) {
    double largest = 0;
    for (const double value : points.reshaped()) {
        largest =
            std::max(largest, std::abs(value - static_cast<double>(static_cast<float>(value))));
    }
    return largest;
}

bool exceed_float32(const Points& points) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    return std::any_of(points.data(), points.data() + points.size(),
                       [](double value) { return std::abs(value) > kLargest; });
}

}  // namespace lpf
