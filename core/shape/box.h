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

    /// Whether a place lies in the box or no further from it than `distance`, axis by axis.
    [[nodiscard]] bool is_near(const Eigen::Vector3d& p, double distance) const {
        return (p.array() >= low.array() - distance).all() &&
               (p.array() < high.array() + distance).all();
    }
};

/// The part of space that is worked on: boxes, or all of it where there are none.
using Region = std::vector<Box>;

[[nodiscard]] inline bool is_near(const Region& region, const Eigen::Vector3d& p, double distance) {
    return region.empty() || std::ranges::any_of(region, [&](const Box& box) {
               return box.is_near(p, distance);
           });
}

}  // namespace lpf
