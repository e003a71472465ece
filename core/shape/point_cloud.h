#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/shape/attribute.h"

namespace lpf {

/// Points: 3 x N, column i = point i, in the units of the input.
using Points = Eigen::Matrix3Xd;

/// Points with their attributes. Every attribute has as many rows as there are points.
struct PointCloud {
    Points points;
    std::vector<Attribute> attributes;

    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(points.cols()); }
};

}  // namespace lpf
