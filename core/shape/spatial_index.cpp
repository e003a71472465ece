#include "core/shape/spatial_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

#include "core/shape/extent.h"

namespace lpf {
namespace {

using Neighbour = SpatialIndex::Neighbour;

constexpr std::uint32_t kReadsPerQuestion = 1U << 16U;  // a millisecond

/// What nanoflann reads: points as columns. While it builds the tree, which it cannot be told to
/// stop, it is asked for a coordinate time and again: there the build is given up.
struct Columns {
    Points points;
    const Execution* building = nullptr;
    mutable std::uint32_t reads = 0;  ///< counted while building, on one thread

    [[nodiscard]] std::size_t kdtree_get_point_count() const {
        return static_cast<std::size_t>(points.cols());
    }
    [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
        if (building != nullptr) [[unlikely]] {
            if (++reads % kReadsPerQuestion == 0) throw_if_cancelled(*building);
        }
        return points(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(i));
    }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
        return false;  // the tree finds it
    }
};

/// Collects the k nearest points in order, straight into the caller's buffer.
class NearestSet {
public:
    NearestSet(std::size_t k, std::vector<Neighbour>& found) : k_(k), found_(found) {}

    [[nodiscard]] std::size_t size() const { return found_.size(); }
    [[nodiscard]] bool full() const { return found_.size() == k_; }
    [[nodiscard]] double worstDist() const {
        return full() ? found_.back().squared_distance : std::numeric_limits<double>::infinity();
    }
    bool addPoint(double squared_distance, std::uint32_t index) {
        // A leaf is read to its end against the worst distance that held at its start.
        if (squared_distance >= worstDist()) return true;
        if (full()) found_.pop_back();
        found_.push_back({index, squared_distance});
        for (std::size_t i = found_.size() - 1; i > 0; --i) {
            if (found_[i - 1].squared_distance <= found_[i].squared_distance) break;
            std::swap(found_[i - 1], found_[i]);
        }
        return true;
    }

private:
    std::size_t k_;
    std::vector<Neighbour>& found_;
};

/// Collects the points of a closed ball.
class BallSet {
public:
    BallSet(double radius, std::vector<Neighbour>& found)
        : limit_(std::nextafter(radius * radius, std::numeric_limits<double>::infinity())),
          found_(found) {}

    [[nodiscard]] std::size_t size() const { return found_.size(); }
    [[nodiscard]] bool full() const { return true; }
    [[nodiscard]] double worstDist() const { return limit_; }  // nanoflann keeps what is below it
    bool addPoint(double squared_distance, std::uint32_t index) {
        found_.push_back({index, squared_distance});
        return true;
    }

private:
    double limit_;
    std::vector<Neighbour>& found_;
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Columns>,
                                                   Columns, 3, std::uint32_t>;

}  // namespace

struct SpatialIndex::Tree {
    Tree(const Points& points, const Execution& execution)
        : centre(centre_of(points, execution)),
          columns{points.colwise() - centre, &execution},
          tree(3, columns) {
        columns.building = nullptr;
    }

    template <typename ResultSet>
    void search(const Eigen::Vector3d& query, ResultSet& results) const {
        if (columns.points.cols() == 0) return;
        const Eigen::Vector3d relative = query - centre;
        tree.findNeighbors(results, relative.data(), {});
    }

    Eigen::Vector3d centre;
    Columns columns;
    KdTree tree;
};

SpatialIndex::SpatialIndex(const Points& points, const Execution& execution)
    : tree_(std::make_unique<Tree>(points, execution)) {}
SpatialIndex::~SpatialIndex() = default;
SpatialIndex::SpatialIndex(SpatialIndex&&) noexcept = default;
SpatialIndex& SpatialIndex::operator=(SpatialIndex&&) noexcept = default;

std::vector<Neighbour> SpatialIndex::nearest(const Eigen::Vector3d& query, std::size_t k) const {
    std::vector<Neighbour> found;
    nearest(query, k, found);
    return found;
}

void SpatialIndex::nearest(const Eigen::Vector3d& query, std::size_t k,
                           std::vector<Neighbour>& found) const {
    found.clear();
    if (k == 0) return;
    NearestSet results(k, found);
    tree_->search(query, results);
}

std::vector<Neighbour> SpatialIndex::within(const Eigen::Vector3d& query, double radius) const {
    std::vector<Neighbour> found;
    within(query, radius, found);
    return found;
}

void SpatialIndex::within(const Eigen::Vector3d& query, double radius,
                          std::vector<Neighbour>& found) const {
    found.clear();
    if (!(radius >= 0)) return;
    BallSet results(radius, found);
    tree_->search(query, results);
}

}  // namespace lpf
