#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lpf {

/// Triangles: 3 x F, column f = the three vertex indices of triangle f.
using Triangles = Eigen::Matrix<std::uint32_t, 3, Eigen::Dynamic>;

}  // namespace lpf
