#pragma once

#include <Eigen/Core>

#include "core/field/frame.h"
#include "core/field/pattern.h"

namespace lpf {

/// x -> R x + t in frame coordinates [radius].
struct RigidFit {
    Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
    Eigen::Vector3f translation = Eigen::Vector3f::Zero();
};

/// The rotation nearest to a correlation matrix S = sum a b': maximises tr(R S), det R = +1.
/// Horn's quaternion method; the identity where S leaves it open.
[[nodiscard]] Eigen::Matrix3f best_rotation(const Eigen::Matrix3d& correlation);

/// Pose optimisation (paper Eq. 4 and 5): R, t that minimise sum |R (u_i + v_i) + t - (u_i +
/// w_i)|^2.
/// @param v,w fields of three channels of pattern.padded_size() floats: probed, and reconstructed
[[nodiscard]] RigidFit fit_pose(const Pattern& pattern, const float* v, const float* w);

/// Moves the frame so that every probed point s + F (u_i + v_i) stays where it is when the field
/// becomes R (u + v) + t - u. Departs from Eq. (6), which moves the probed points when taken
/// literally.
void apply_pose(const RigidFit& fit, Frame& frame);

/// v_i <- R (u_i + v_i) + t - u_i.
void move_field(const Pattern& pattern, const RigidFit& fit, float* v);

}  // namespace lpf
