#pragma once

#include <memory>
#include <vector>

#include "core/shape/point_cloud.h"

namespace lpf {

/// How the noise of a shape varies from place to place, relative to the noise that stands for all
/// of it. Cheap to copy; any number of threads may ask.
class NoiseMap {
public:
    /// The same everywhere.
    NoiseMap() = default;

    /// @param places at least one @param factors of the noise there, > 0
    NoiseMap(const Points& places, std::vector<double> factors);

    [[nodiscard]] bool is_even() const { return !known_; }

    /// By so much there is more noise than usual; 1 everywhere where it is even.
    [[nodiscard]] double factor_at(const Eigen::Vector3d& place) const;

    /// The largest factor, and the smallest.
    [[nodiscard]] double most() const;
    [[nodiscard]] double least() const;

private:
    struct Known;
    std::shared_ptr<const Known> known_;
};

}  // namespace lpf
