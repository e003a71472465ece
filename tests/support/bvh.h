#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace lpf::test {

/// A bounding-volume hierarchy over items that are known by their boxes. Independent of the index
/// in core, so that tests of core do not measure it with itself.
class Bvh {
public:
    struct Hit {
        std::uint32_t item = 0;
        double squared_distance = std::numeric_limits<double>::infinity();
    };

    Bvh() = default;
    explicit Bvh(const std::vector<Eigen::AlignedBox3d>& boxes) {
        order_.resize(boxes.size());
        std::iota(order_.begin(), order_.end(), 0U);
        if (!boxes.empty()) build(boxes, 0, order_.size());
    }

    /// The item with the least `squared_distance(item)`; boxes only prune, so the answer is exact.
    template <typename SquaredDistance>
    [[nodiscard]] Hit nearest(const Eigen::Vector3d& query,
                              const SquaredDistance& squared_distance) const {
        Hit best;
        if (!nodes_.empty()) descend(0, query, squared_distance, best);
        return best;
    }

private:
    static constexpr std::size_t kLeafSize = 4;

    struct Node {
        Eigen::AlignedBox3d box;
        std::size_t begin = 0;
        std::size_t end = 0;
        std::size_t right = 0;  // 0 for a leaf; the left child follows its parent
    };

    std::size_t build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin,
                      std::size_t end) {
        const std::size_t self = nodes_.size();
        nodes_.push_back({{}, begin, end, 0});
        for (std::size_t i = begin; i < end; ++i) nodes_[self].box.extend(boxes[order_[i]]);
        if (end - begin <= kLeafSize) return self;
        Eigen::Index axis = 0;
        nodes_[self].box.sizes().maxCoeff(&axis);
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return order_.begin() + static_cast<long>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            return boxes[a].center()[axis] < boxes[b].center()[axis];
        });
        build(boxes, begin, middle);
        nodes_[self].right = build(boxes, middle, end);
        return self;
    }

    template <typename SquaredDistance>
    void descend(std::size_t self, const Eigen::Vector3d& query,
                 const SquaredDistance& squared_distance, Hit& best) const {
        const Node& node = nodes_[self];
        if (node.right == 0) {
            for (std::size_t i = node.begin; i < node.end; ++i) {
                const double squared = squared_distance(order_[i]);
                if (squared < best.squared_distance) best = {order_[i], squared};
            }
            return;
        }
        std::pair<double, std::size_t> near{nodes_[self + 1].box.squaredExteriorDistance(query),
                                            self + 1};
        std::pair<double, std::size_t> far{nodes_[node.right].box.squaredExteriorDistance(query),
                                           node.right};
        if (far.first < near.first) std::swap(near, far);
        if (near.first < best.squared_distance) {
            descend(near.second, query, squared_distance, best);
        }
        if (far.first < best.squared_distance) descend(far.second, query, squared_distance, best);
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace lpf::test
