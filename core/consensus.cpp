#include "core/consensus.h"

#include "core/shape/hash_grid.h"

namespace lpf {
namespace {

constexpr std::size_t kCandidatesPerChunk = 1U << 14U;

HashGrid make_grid(const Candidates& candidates, double spacing) {
    Eigen::Vector3d low = candidates.points.front();
    Eigen::Vector3d high = low;
    for (const Eigen::Vector3d& point : candidates.points) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    return {low, (high - low).maxCoeff(), spacing};
}

Eigen::Vector3d mean_around(const HashGrid& grid, const Eigen::Vector3d& at) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
    grid.for_each_near(at, [&](std::uint32_t, const Eigen::Vector3d& point) {
        sum += point;
        ++count;
        return true;
    });
    return sum / count;
}

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
    HashGrid all = make_grid(candidates, spacing);
    HashGrid accepted = make_grid(candidates, spacing);
    for (const Eigen::Vector3d& point : candidates.points) all.add(point);
    std::vector<std::uint8_t> spent(candidates.size(), 0);

    const auto consider = [&](std::size_t i) {
        if (spent[i]) return;
        const Eigen::Vector3d& proposed = candidates.points[i];
        Eigen::Vector3d point = mean_around(all, proposed);
        // The mean may run into a point accepted before; the proposal itself is free then.
        if (!is_free(accepted, point)) point = proposed;
        accepted.add(point);
        result.points.push_back(point);
        result.field.push_back(candidates.field[i]);
        all.for_each_near(point, [&](std::uint32_t k, const Eigen::Vector3d&) {
            spent[k] = 1;
            return true;
        });
        spent[i] = 1;
    };
    // Each choice depends on those before: one thread.
    Execution sequential = execution;
    sequential.threads = 1;
    parallel_for(sequential, "consensus", "candidates", candidates.size(), kCandidatesPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) consider(i);
                 });
    return result;
}

}  // namespace lpf
