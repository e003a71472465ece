#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/shape/point_cloud.h"

namespace lpf {

/// Nearest-neighbour search over points (a kd-tree). Coordinates are kept relative to the centre of
/// the bounding box. Read-only after construction: any number of threads may search.
class SpatialIndex {
public:
    /// @pre all coordinates finite. An empty cloud is allowed and finds nothing.
    explicit SpatialIndex(const Points& points);
    ~SpatialIndex();
    SpatialIndex(SpatialIndex&&) noexcept;
    SpatialIndex& operator=(SpatialIndex&&) noexcept;

    struct Neighbour {
        std::uint32_t index;
        double squared_distance;
    };

    /// The k nearest points to `query`, nearest first; fewer if the cloud has fewer.
    [[nodiscard]] std::vector<Neighbour> nearest(const Eigen::Vector3d& query, std::size_t k) const;

    /// All points within `radius` (inclusive), in no particular order.
    [[nodiscard]] std::vector<Neighbour> within(const Eigen::Vector3d& query, double radius) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace lpf
