#pragma once

#include <cstddef>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_grid.h"
#include "core/shape/spread.h"

namespace lpf {

/// A cloud, and those of its points that all others near them belong to; empty: it is whole.
struct SampledCloud {
    const Points& points;
    std::vector<Eigen::Index> complete = {};

    /// Up to `count` of them spread over the cloud, the same for every run.
    [[nodiscard]] std::vector<Eigen::Index> some(std::size_t count) const;
};

/// Room to read in, used again and again.
struct NoiseScratch {
    NearPoints ball;
    std::vector<double> heights;
};

/// How the points in the ball around a place of a shape scatter.
struct NoiseReading {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< the point that the ball was put around
    double radius = 0.0;  ///< of the ball [input length]; 0: it says nothing
    Spread spread = {};

    /// The noise that a deviation [radius] of these points stands for [input length].
    /// @param below chance has put the deviation so many of its own deviations below the mean
    [[nodiscard]] double noise(double deviation, double below) const;
};

/// The spread about a place; nothing where a point is alone, or one of a heap of equal ones.
[[nodiscard]] NoiseReading read_noise(const PointGrid& grid, const Eigen::Vector3d& point,
                                      double radius, NoiseScratch& scratch);

/// Around some points of a cloud, with readings that say nothing left out, and those of curves
/// where not most are: off a curve, noise has two directions, and the smaller spread of the two
/// says too little.
[[nodiscard]] std::vector<NoiseReading> read_noise(const SampledCloud& cloud, const PointGrid& grid,
                                                   double radius, std::size_t balls,
                                                   const Execution& execution);

}  // namespace lpf
