#pragma once

#include <cstdint>

#include "core/base/random.h"
#include "core/field/frame.h"
#include "core/field/target_area.h"

namespace lpf {

/// Target areas with fewer points say nothing about a shape: their LPF neither moves nor votes.
inline constexpr std::size_t kFewestTargetPoints = 8;

/// What a target area looks like: the number of its directions of extent.
enum Dimension : std::uint8_t { kTooFewPoints = 0, kCurve = 1, kSurface = 2 };

/// Eigenvalues l1 >= l2 >= l3 of a target area's covariance [radius^2], and its principal
/// directions.
struct PrincipalDirections {
    Eigen::Vector3f mean;
    Eigen::Vector3f variances;  ///< l1, l2, l3
    Eigen::Matrix3f axes;       ///< columns of l1, l2, l3; in SO(3); always finite
};

/// @param target in centre-relative coordinates, not empty
[[nodiscard]] PrincipalDirections principal_directions(const TargetArea& target);

/// A curve iff (l2 - l3) / (l1 - l3) < .19: subtracting l3 cancels isotropic noise. A straight
/// border gives .28, a right-angled edge .42, a corner .54, a curve nearly 0.
[[nodiscard]] Dimension local_dimension(const PrincipalDirections& principal, std::size_t points);

/// First pose: t1, t2, n along the principal directions, the seed on the mean plane below the
/// centre.
void align_with_principal_directions(const PrincipalDirections& principal, Frame& frame);

/// First pose of the paper: a uniformly random rotation at the centre (Sec. 3.1).
void rotate_randomly(Random& random, Frame& frame);

}  // namespace lpf
