#include "core/learn/pose.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/kernels.h"

namespace lpf {
namespace {

/// Keeps the rotation at the identity about axes that the points leave open: lines, one to three
/// points [radius^2].
constexpr double kRegularisation = 1e-3;

/// Horn's symmetric, trace-free 4 x 4 matrix: its top eigenvector is the best unit quaternion.
Eigen::Matrix4d horn_matrix(const Eigen::Matrix3d& s) {
    Eigen::Matrix4d n;
    n(0, 0) = s.trace();
    n.block<1, 3>(0, 1) << s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0);
    n.block<3, 1>(1, 0) = n.block<1, 3>(0, 1).transpose();
    n.block<3, 3>(1, 1) = s + s.transpose() - s.trace() * Eigen::Matrix3d::Identity();
    return n;
}

/// Largest root of det(N - x I) = x^4 + c2 x^2 + c1 x + c0: Newton from above, which falls
/// monotonically on the convex part beyond the largest root.
double largest_eigenvalue(const Eigen::Matrix3d& s, const Eigen::Matrix4d& n) {
    const double c2 = -2 * s.squaredNorm();
    const double c1 = -8 * s.determinant();
    const double c0 = n.determinant();
    double x = std::sqrt(3.0) * s.norm();
    for (int i = 0; i < 60; ++i) {
        const double p = ((x * x + c2) * x + c1) * x + c0;
        const double slope = (4 * x * x + 2 * c2) * x + c1;
        if (slope <= 0) break;
        const double next = x - p / slope;
        if (std::abs(next - x) <= 1e-13 * std::abs(x)) return next;
        x = next;
    }
    return x;
}

/// Determinant of m without row r and column c, with the sign of the cofactor.
double cofactor(const Eigen::Matrix4d& m, int r, int c) {
    Eigen::Matrix3d minor;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) minor(i, j) = m(i + (i >= r), j + (j >= c));
    }
    return ((r + c) % 2 ? -1 : 1) * minor.determinant();
}

}  // namespace

Eigen::Matrix3f best_rotation(const Eigen::Matrix3d& correlation) {
    // A common scale changes nothing and keeps the quartic's coefficients of order one.
    const double scale = correlation.norm();
    if (!(scale > 0) || !std::isfinite(scale)) return Eigen::Matrix3f::Identity();
    const Eigen::Matrix3d s = correlation / scale;
    Eigen::Matrix4d n = horn_matrix(s);
    n.diagonal().array() -= largest_eigenvalue(s, n);

    // Every column of the adjugate is a multiple of the eigenvector; the longest is the safest.
    int column = 0;
    double largest = 0;
    for (int i = 0; i < 4; ++i) {
        const double diagonal = std::abs(cofactor(n, i, i));
        if (diagonal > largest) {
            largest = diagonal;
            column = i;
        }
    }
    if (largest < 1e-14) return Eigen::Matrix3f::Identity();
    Eigen::Vector4d q;
    for (int i = 0; i < 4; ++i) q[i] = cofactor(n, i, column);
    q.normalize();
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix().cast<float>();
}

RigidFit fit_pose(const Pattern& pattern, const float* v, const float* w) {
    const auto stride = static_cast<std::size_t>(pattern.padded_size());
    const kernels::PairMoments sums = kernels::pair_moments(pattern.channel(0), v, w, stride);
    const double inverse = 1.0 / pattern.size();
    const Eigen::Vector3d a = inverse * Eigen::Vector3f(sums.a).cast<double>();
    const Eigen::Vector3d b = inverse * Eigen::Vector3f(sums.b).cast<double>();
    const Eigen::Matrix3f ab =
        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(sums.ab);
    const Eigen::Matrix3d correlation = inverse * ab.cast<double>() - a * b.transpose() +
                                        kRegularisation * Eigen::Matrix3d::Identity();
    RigidFit fit;
    fit.rotation = best_rotation(correlation);
    fit.translation = b.cast<float>() - fit.rotation * a.cast<float>();
    return fit;
}

void apply_pose(const RigidFit& fit, Frame& frame) {
    // s' + F' (R p + t) = s + F p for every p gives F' = F R', s' = s - F' t.
    const Eigen::Matrix3f axes = frame.axes * fit.rotation.transpose();
    frame.axes.col(0) = axes.col(0).normalized();
    frame.axes.col(1) =
        (axes.col(1) - frame.axes.col(0) * frame.axes.col(0).dot(axes.col(1))).normalized();
    frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
    frame.origin -= frame.axes * fit.translation;
}

void move_field(const Pattern& pattern, const RigidFit& fit, float* v) {
    const auto stride = static_cast<std::size_t>(pattern.padded_size());
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rotation = fit.rotation;
    kernels::move_points(rotation.data(), fit.translation.data(), pattern.channel(0), stride, v);
    for (std::size_t c = 0; c < 3; ++c) {
        std::fill(v + c * stride + pattern.size(), v + (c + 1) * stride, 0.0F);
    }
}

}  // namespace lpf
