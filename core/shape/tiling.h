#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/box.h"
#include "core/shape/point_source.h"

namespace lpf {

/// A few points of a large cloud that tell where the others lie.
struct Sketch {
    std::vector<Eigen::Vector3d> points;            ///< evenly over the order of the input
    std::size_t of = 0;                             ///< finite points of the cloud
    Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< of them all
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
};

/// Reads the cloud once.
[[nodiscard]] Sketch make_sketch(const PointSource& source, const Execution& execution);

/// Space cut into boxes of about as many points each: a k-d tree over a sketch, cut at medians.
class Partition {
public:
    /// @param most points of the cloud in a box, about
    Partition(const Sketch& sketch, double most);

    /// The boxes; neighbours in space are neighbours in number.
    [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }

    /// Visits the boxes that a place lies in or near to, by their numbers, ascending.
    template <typename Visit>
    void for_each_near(const Eigen::Vector3d& place, double distance, const Visit& visit) const {
        descend(0, place, distance, {}, visit);
    }

    /// Some of the boxes, evenly over all. @returns their numbers, ascending
    [[nodiscard]] std::vector<std::uint32_t> choose(std::size_t count) const;

    /// Whether places lie in or near to one of some boxes. Most that do not are told by a raster.
    class Nearness {
    public:
        /// @param distance how near is near [input length], >= 0
        Nearness(const Partition& partition, const std::vector<std::uint32_t>& boxes,
                 double distance);

        [[nodiscard]] bool operator()(const Eigen::Vector3d& place) const {
            return may_be_near(place) && is_near(place, distance_);
        }

    private:
        static constexpr int kCells = 64;

        [[nodiscard]] bool is_near(const Eigen::Vector3d& place, double distance) const {
            bool near = false;
            partition_.descend(0, place, distance, leads_to_, [&](std::uint32_t) { near = true; });
            return near;
        }

        /// By the cell that the place lies in.
        [[nodiscard]] bool may_be_near(const Eigen::Vector3d& place) const {
            const Eigen::Array3d cell = (place - partition_.low_).array() * cells_per_length_;
            if (!((cell >= 0).all() && (cell < kCells).all())) return true;
            const Eigen::Array3i at = cell.cast<int>();
            return cells_[static_cast<std::size_t>((at[2] * kCells + at[1]) * kCells + at[0])];
        }

        const Partition& partition_;
        std::vector<std::uint8_t> leads_to_;
        double distance_;
        Eigen::Array3d cells_per_length_;
        std::vector<bool> cells_;
    };

private:
    struct Node {
        int axis = -1;  // -1: a box
        double cut = 0.0;
        std::uint32_t low = 0;  // node below the cut; number of the box
        std::uint32_t high = 0;
    };

    std::uint32_t build(std::span<Eigen::Vector3d> points, double most, const Box& box);

    /// @returns for each node whether one of the boxes lies below it
    [[nodiscard]] std::vector<std::uint8_t> nodes_above(
        const std::vector<std::uint32_t>& boxes) const;

    /// @param among the nodes that are descended to; empty: all
    template <typename Visit>
    void descend(std::uint32_t at, const Eigen::Vector3d& place, double distance,
                 std::span<const std::uint8_t> among, const Visit& visit) const {
        if (!among.empty() && !among[at]) return;
        const Node& node = nodes_[at];
        if (node.axis < 0) return visit(node.low);
        const double beyond = place[node.axis] - node.cut;
        if (beyond < distance) descend(node.low, place, distance, among, visit);
        if (beyond >= -distance) descend(node.high, place, distance, among, visit);
    }

    Eigen::Vector3d low_, high_;  // of the cloud
    std::vector<Node> nodes_;
    std::vector<Box> boxes_;
};

/// Which points of a cloud lie in each box, and near it. Points that are not finite lie in none.
class Tiling {
public:
    /// Reads the cloud twice.
    /// @param margin how near a point has to be to belong to a tile [input length], >= 0
    Tiling(const PointSource& source, const Partition& partition, double margin,
           const Execution& execution);

    [[nodiscard]] std::size_t size() const { return first_.size() - 1; }

    /// Indices of the points of a tile, ascending.
    [[nodiscard]] std::span<const std::uint32_t> points(std::size_t tile) const {
        return std::span(indices_).subspan(first_[tile], first_[tile + 1] - first_[tile]);
    }

private:
    std::vector<std::size_t> first_;  // of each tile, into indices_; one more than there are
    std::vector<std::uint32_t> indices_;
};

/// Parts of a cloud that stand for all of it: some boxes of a fine partition.
struct Excerpt {
    Region boxes;
    std::vector<std::uint32_t> points;  ///< in or near the boxes, ascending
};

/// Reads the cloud once.
/// @param margin how near to a box a point has to be [input length], >= 0
[[nodiscard]] Excerpt make_excerpt(const PointSource& source, const Partition& partition,
                                   std::size_t boxes, double margin, const Execution& execution);

}  // namespace lpf
