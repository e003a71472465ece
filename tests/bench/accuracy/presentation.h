#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/shape/point_cloud.h"

namespace lpf::accuracy {

/// How a scan is presented to the method: where, and with which random numbers. The answer is to be
/// as near to the shape, whatever it is.
struct Presentation {
    std::string name = "as it is";
    std::uint64_t random_seed = 1;  ///< of the method, not of the scan
    Eigen::Affine3d placing = Eigen::Affine3d::Identity();

    [[nodiscard]] Points placed(const Points& points) const { return placing * points; }
    [[nodiscard]] Points placed_back(const Points& points) const {
        return placing.inverse() * points;
    }
    /// A length where the scan was made, from one where it is placed.
    [[nodiscard]] double length_before(double placed) const {
        return placed / std::cbrt(placing.linear().determinant());
    }
};

/// A rotation that leads no axis to another.
[[nodiscard]] Eigen::Matrix3d some_turn();

/// As it is; with other random numbers; far away, turned, in another unit.
[[nodiscard]] std::vector<Presentation> presentations();

}  // namespace lpf::accuracy
