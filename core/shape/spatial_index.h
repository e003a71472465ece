#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// Nearest-neighbour search over points (a kd-tree). Coordinates are kept relative to the centre of
/// the bounding box. Read-only after construction: any number of threads may search.
class SpatialIndex {
public:
    /// @pre all coordinates finite. An empty cloud is allowed and finds nothing.
    /// @throws Error{Cancelled} when the stop token fires while the tree is built
    explicit SpatialIndex(const Points& points, const Execution& execution = {});
    ~SpatialIndex();
    SpatialIndex(SpatialIndex&&) noexcept;
    SpatialIndex& operator=(SpatialIndex&&) noexcept;

    struct Neighbour {
        std::uint32_t index;
        double squared_distance;
    };

    /// The k nearest points to `query`, nearest first; fewer if the cloud has fewer. Points at the
    /// same distance come in no particular order.
    [[nodiscard]] std::vector<Neighbour> nearest(const Eigen::Vector3d& query, std::size_t k) const;

    /// The same into a buffer that is used again and again, for loops over many queries.
    void nearest(const Eigen::Vector3d& query, std::size_t k, std::vector<Neighbour>& found) const;

    /// All points within `radius` (inclusive), in no particular order.
    [[nodiscard]] std::vector<Neighbour> within(const Eigen::Vector3d& query, double radius) const;

    /// The same into a buffer that is used again and again.
    void within(const Eigen::Vector3d& query, double radius, std::vector<Neighbour>& found) const;

private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
};

}  // namespace lpf
