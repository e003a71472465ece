#pragma once

#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// Unit normals by principal component analysis of the k nearest points, turned away from the
/// centre of the cloud (a convention, not an orientation). A point without a plane gets (0, 0, 1).
/// @returns 3 x N
[[nodiscard]] Eigen::Matrix3Xf estimate_normals(const Points& points, int k,
                                                const Execution& execution);

}  // namespace lpf
