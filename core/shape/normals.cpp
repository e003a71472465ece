#include "core/shape/normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <vector>

#include "core/shape/extent.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

/// Second eigenvalue over the first below which the neighbours span no plane.
constexpr double kLine = 1e-9;

using Neighbours = std::vector<SpatialIndex::Neighbour>;

Eigen::Matrix3d covariance(const Points& points, const Neighbours& neighbours) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    const Eigen::Vector3d origin = points.col(neighbours.front().index);
    for (const auto& n : neighbours) mean += points.col(n.index) - origin;
    mean /= static_cast<double>(neighbours.size());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const auto& n : neighbours) {
        const Eigen::Vector3d offset = points.col(n.index) - origin - mean;
        sum += offset * offset.transpose();
    }
    return sum;
}

/// Direction of least spread, or zero where the neighbours span no plane.
Eigen::Vector3d least_direction(const Eigen::Matrix3d& spread) {
    // Iterative: the closed form is off by 1e-8, too much to tell a line from a narrow strip.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
    const Eigen::Vector3d& values = solver.eigenvalues();  // ascending
    if (!(values[1] > kLine * values[2])) return Eigen::Vector3d::Zero();
    return solver.eigenvectors().col(0);
}

/// Turns the normal away from the centre; one that lies across the way to it has no such side and
/// points along its greatest coordinate. No direction at all becomes (0, 0, 1).
Eigen::Vector3d turned(const Eigen::Vector3d& normal, const Eigen::Vector3d& outwards) {
    if (normal.isZero()) return Eigen::Vector3d::UnitZ();
    double side = normal.dot(outwards);
    if (std::abs(side) <= 1e-9 * outwards.norm()) {
        Eigen::Index greatest = 0;
        normal.cwiseAbs().maxCoeff(&greatest);
        side = normal[greatest];
    }
    return side < 0 ? -normal : normal;
}

}  // namespace

Eigen::Matrix3Xf estimate_normals(const Points& points, int k, const Execution& execution) {
    Eigen::Matrix3Xf normals(3, points.cols());
    if (points.cols() == 0) return normals;
    const SpatialIndex index(points, execution);
    const Eigen::Vector3d centre = centre_of(points, execution);
    const auto wanted = static_cast<std::size_t>(std::max(k, 3));
    parallel_for(execution, "normals", "points", static_cast<std::size_t>(points.cols()), 4096,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     Neighbours found;
                     for (std::size_t i = begin; i < end; ++i) {
                         const auto column = static_cast<Eigen::Index>(i);
                         const Eigen::Vector3d point = points.col(column);
                         index.nearest(point, wanted, found);
                         const Eigen::Vector3d normal = least_direction(covariance(points, found));
                         normals.col(column) = turned(normal, point - centre).cast<float>();
                     }
                 });
    return normals;
}

}  // namespace lpf
