#include "core/consensus.h"

#include "core/field/target_area.h"
#include "core/shape/hash_grid.h"

namespace lpf {
namespace {

constexpr std::size_t kCandidatesPerChunk = 1U << 14U;

/// All candidates, sorted into cells, so that those around a place lie together in memory.
class CandidateGrid {
public:
    CandidateGrid(const Points& points, double spacing) : grid_(points, spacing) {
        around_.radius = spacing;
    }

    Eigen::Vector3d mean_around(const Eigen::Vector3d& at) {
        gather(at);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < found_.size; ++i) {
            sum += Eigen::Vector3d(found_.x[i], found_.y[i], found_.z[i]);
        }
        return at + around_.radius / static_cast<double>(found_.size) * sum;
    }

    template <typename Visit>
    void for_each_near(const Eigen::Vector3d& at, Visit visit) {
        gather(at);
        for (std::size_t i = 0; i < found_.size; ++i) visit(grid_.order()[found_.index[i]]);
    }

private:
    void gather(const Eigen::Vector3d& at) {
        around_.centre = at;
        grid_.gather(around_.centre, around_.radius, 1.0F, found_);
    }

    PointGrid grid_;
    Frame around_;
    TargetArea found_;
};

bool is_free(const HashGrid& accepted, const Eigen::Vector3d& at) {
    bool free = true;
    accepted.for_each_near(at, [&](std::uint32_t, const Eigen::Vector3d&) { return free = false; });
    return free;
}

}  // namespace

Candidates find_consensus(const Candidates& candidates, double spacing,
                          const Execution& execution) {
    Candidates result;
    if (candidates.size() == 0) return result;
    const Eigen::Vector3d low = candidates.points.rowwise().minCoeff();
    const double extent = (candidates.points.rowwise().maxCoeff() - low).maxCoeff();
    CandidateGrid all(candidates.points, spacing);
    HashGrid accepted(low, extent, spacing);
    std::vector<std::uint8_t> spent(candidates.size(), 0);
    std::vector<Eigen::Vector3d> points;

    const auto consider = [&](std::size_t i) {
        if (spent[i]) return;
        const Eigen::Vector3d proposed = candidates.points.col(static_cast<Eigen::Index>(i));
        Eigen::Vector3d point = all.mean_around(proposed);
        // The mean may run into a point accepted before; the proposal itself is free then.
        if (!is_free(accepted, point)) point = proposed;
        if (!is_free(accepted, point)) return;
        accepted.add(point);
        points.push_back(point);
        result.field.push_back(candidates.field[i]);
        all.for_each_near(point, [&](std::uint32_t k) { spent[k] = 1; });
    };
    // Each choice depends on those before: one thread.
    Execution sequential = execution;
    sequential.threads = 1;
    parallel_for(sequential, "consensus", "candidates", candidates.size(), kCandidatesPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) consider(i);
                 });
    result.points = Eigen::Map<const Points>(points.empty() ? nullptr : points.front().data(), 3,
                                             static_cast<Eigen::Index>(points.size()));
    return result;
}

}  // namespace lpf
