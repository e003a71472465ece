#pragma once

#include <memory>
#include <vector>

#include "tests/support/pieces.h"

namespace lpf::test {

/// A simple solid, to build bodies from.
class Solid {
public:
    virtual ~Solid() = default;
    [[nodiscard]] virtual double area() const = 0;
    [[nodiscard]] virtual Vector3d sample(Random& random) const = 0;  ///< uniform on its surface
    /// To its surface, less than 0 inside.
    [[nodiscard]] virtual double signed_distance(const Vector3d& point) const = 0;
    [[nodiscard]] virtual Eigen::AlignedBox3d box() const = 0;
};

using SolidPtr = std::shared_ptr<const Solid>;

SolidPtr ball(const Vector3d& centre, double radius);

/// All within `radius` of a segment.
SolidPtr capsule(const Vector3d& from, const Vector3d& to, double radius);

/// With edges along the axes.
SolidPtr block(const Vector3d& low, const Vector3d& high);

/// All within `radius` of a horizontal circle.
SolidPtr ring(const Vector3d& centre, double circle, double radius);

/// The surface of the union of solids. Distances are exact outside of it, and inside but near
/// where solids meet, where they are a little too small.
PiecePtr union_surface(const std::vector<SolidPtr>& solids);

}  // namespace lpf::test
