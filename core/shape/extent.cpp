#include "core/shape/extent.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace lpf {
namespace {

constexpr std::size_t kFewestPoints = 3;

/// A pass over the points of a chunk. Of three axes each on its own the compiler makes vectors.
Eigen::AlignedBox3d box_of(const double* points, std::size_t n) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double low[3] = {kInfinity, kInfinity, kInfinity};
    double high[3] = {-kInfinity, -kInfinity, -kInfinity};
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double at = points[3 * i + axis];
            low[axis] = at < low[axis] ? at : low[axis];
            high[axis] = at > high[axis] ? at : high[axis];
        }
    }
    return {Eigen::Vector3d(low), Eigen::Vector3d(high)};
}

bool are_finite(const double* values, std::size_t n) {
    int others = 0;
    for (std::size_t i = 0; i < n; ++i) {
        others |= static_cast<int>(!(std::abs(values[i]) <= std::numeric_limits<double>::max()));
    }
    return others == 0;
}

}  // namespace

Eigen::AlignedBox3d bounding_box(const Points& points, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<Eigen::AlignedBox3d> parts(chunk_count(n, kPointsPerChunk));
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     parts[chunk] = box_of(points.data() + 3 * begin, end - begin);
                 });
    Eigen::AlignedBox3d box;
    for (const Eigen::AlignedBox3d& part : parts) box.extend(part);
    return box;
}

Eigen::Vector3d centre_of(const Points& points, const Execution& execution) {
    if (points.cols() == 0) return Eigen::Vector3d::Zero();
    const Eigen::AlignedBox3d box = bounding_box(points, execution);
    return box.min() / 2 + box.max() / 2;
}

Points selected(const Points& points, std::span<const std::uint32_t> numbers,
                const Execution& execution) {
    Points some(3, static_cast<Eigen::Index>(numbers.size()));
    parallel_for(execution, numbers.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         some.col(static_cast<Eigen::Index>(i)) = points.col(numbers[i]);
                     }
                 });
    return some;
}

bool all_finite(const Points& points, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<std::uint8_t> finite(chunk_count(n, kPointsPerChunk));
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     finite[chunk] = are_finite(points.data() + 3 * begin, 3 * (end - begin));
                 });
    return std::ranges::all_of(finite, [](std::uint8_t is) { return is != 0; });
}

void check_number_of_points(std::size_t points) {
    if (points >= kFewestPoints) return;
    throw Error(ErrorCode::TooFewPoints,
                "The shape has " + std::to_string(points) + " points; at least 3 are needed.");
}

void check_extent(double extent) {
    if (extent > 0) return;
    throw Error(ErrorCode::DegenerateShape, "All points of the shape coincide: it has no extent.");
}

}  // namespace lpf
