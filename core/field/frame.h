#pragma once

#include <Eigen/Core>

namespace lpf {

/// Pose of one LPF: where its pattern sits. Local coordinates are float32, in units of the LPF's
/// radius, relative to the fixed centre of its target area, so that coordinates of any size lose
/// nothing.
struct Frame {
    Eigen::Vector3d centre;  ///< centre of the target area, fixed for good [input length]
    double radius = 1.0;     ///< r of this LPF [input length], > 0
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();    ///< seed s - centre [radius]
    Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns t1, t2, n; in SO(3)

    /// The seed s [input length].
    [[nodiscard]] Eigen::Vector3d seed() const { return centre + radius * origin.cast<double>(); }

    /// s + r F p: from frame coordinates [radius] to the input's space.
    [[nodiscard]] Eigen::Vector3d to_world(const Eigen::Vector3f& p) const {
        return centre + radius * (origin + axes * p).cast<double>();
    }

    /// The inverse of to_world.
    [[nodiscard]] Eigen::Vector3f to_local(const Eigen::Vector3d& world) const {
        return axes.transpose() * (((world - centre) / radius).cast<float>() - origin);
    }
};

}  // namespace lpf
