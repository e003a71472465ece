#pragma once

#include "core/shape/point_cloud.h"
#include "core/shape/triangle_mesh.h"

namespace lpf {

/// What is uploaded and what is worked on: points, and triangles over them if it is a mesh.
struct Shape {
    PointCloud cloud;
    Triangles triangles;  ///< 3 x F; F = 0 for a point cloud. @invariant every index < cloud.size()

    [[nodiscard]] std::size_t size() const { return cloud.size(); }
    [[nodiscard]] bool is_mesh() const { return triangles.cols() > 0; }
};

}  // namespace lpf
