#pragma once

#include "core/field/target_area.h"

namespace lpf::test {

/// A target area of these points, taken as they are.
inline TargetArea target_of(const Eigen::Matrix3Xf& points) {
    TargetArea target;
    target.size = static_cast<std::size_t>(points.cols());
    target.reserve(target.size);
    for (std::size_t i = 0; i < target.size; ++i) {
        const auto column = static_cast<Eigen::Index>(i);
        target.x[i] = points(0, column);
        target.y[i] = points(1, column);
        target.z[i] = points(2, column);
        target.index[i] = static_cast<std::uint32_t>(i);
    }
    return target;
}

}  // namespace lpf::test
