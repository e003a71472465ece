#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

namespace lpf {

/// A box along the axes: low <= p < high. May reach to infinity.
struct Box {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
    Eigen::Vector3d high = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());

    [[nodiscard]] bool holds(const Eigen::Vector3d& p) const {
        return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
    }

    /// How far a place lies outside, along the axis where that is furthest; 0 within.
    [[nodiscard]] double distance_to(const Eigen::Vector3d& p) const {
        return std::max(0.0, (low - p).cwiseMax(p - high).maxCoeff());
    }
};

/// The part of space that is worked on: boxes, or all of it where there are none.
using Region = std::vector<Box>;

/// To the nearest box; 0 where there are none.
[[nodiscard]] inline double distance_to(const Region& region, const Eigen::Vector3d& p) {
    double nearest = region.empty() ? 0.0 : std::numeric_limits<double>::infinity();
    for (const Box& box : region) nearest = std::min(nearest, box.distance_to(p));
    return nearest;
}

}  // namespace lpf
