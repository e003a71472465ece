#include "core/field/local_probing_field.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "core/base/kernels.h"

namespace lpf {
namespace {

constexpr float kCurveThreshold = 0.19F;

}  // namespace

PrincipalDirections principal_directions(const TargetArea& target) {
    float sums[9];
    kernels::second_moments(target.x.data(), target.y.data(), target.z.data(), target.size, sums);
    const double inverse = 1.0 / static_cast<double>(target.size);
    const Eigen::Vector3d mean = inverse * Eigen::Vector3d(sums[0], sums[1], sums[2]);
    Eigen::Matrix3d covariance;
    covariance << sums[3], sums[4], sums[5],  //
        sums[4], sums[6], sums[7],            //
        sums[5], sums[7], sums[8];
    covariance = inverse * covariance - mean * mean.transpose();

    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();  // allFinite reads every column
    axes.col(0) = solver.eigenvectors().col(2);
    axes.col(2) = solver.eigenvectors().col(0);
    // Equal points and exact lines leave directions open; any right-handed frame is as good then.
    if (!axes.allFinite() || std::abs(axes.col(0).dot(axes.col(2))) > 1e-3) {
        axes.col(0) = axes.col(0).allFinite() && axes.col(0).norm() > 0.5
                          ? Eigen::Vector3d(axes.col(0))
                          : Eigen::Vector3d::UnitX();
        axes.col(2) = axes.col(0).unitOrthogonal();
    }
    axes.col(1) = axes.col(2).cross(axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1)).normalized();
    return {mean.cast<float>(), solver.eigenvalues().reverse().cwiseMax(0.0).cast<float>(),
            axes.cast<float>()};
}

Dimension local_dimension(const PrincipalDirections& principal, std::size_t points) {
    if (points < kFewestTargetPoints) return kTooFewPoints;
    const Eigen::Vector3f& l = principal.variances;
    return l[1] - l[2] < kCurveThreshold * (l[0] - l[2]) ? kCurve : kSurface;
}

void align_with_principal_directions(const PrincipalDirections& principal, Frame& frame) {
    frame.axes = principal.axes;
    const Eigen::Vector3f normal = principal.axes.col(2);
    frame.origin = normal * normal.dot(principal.mean);
}

void rotate_randomly(Random& random, Frame& frame) {
    // Shoemake's uniform random quaternion.
    const double u = random.uniform();
    const double a = 2.0 * std::numbers::pi * random.uniform();
    const double b = 2.0 * std::numbers::pi * random.uniform();
    const Eigen::Quaterniond q(std::sqrt(1 - u) * std::sin(a), std::sqrt(1 - u) * std::cos(a),
                               std::sqrt(u) * std::sin(b), std::sqrt(u) * std::cos(b));
    frame.axes = q.normalized().toRotationMatrix().cast<float>();
    frame.origin.setZero();
}

}  // namespace lpf
