#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/base/parallel.h"

namespace lpf {

/// What one LPF proposes for the points that it votes on: structure of arrays.
struct Votes {
    std::span<const std::uint32_t> point;  ///< ascending, in the order of the FieldSet's grid
    std::span<const float> weight;         ///< 0: no vote
    const float* move[3];                  ///< [radius]
};

/// The moves that LPFs propose for every point, summed: weight, and weighted move [radius]. In
/// fixed point, so that the order of the threads changes no digit.
class Ballot {
public:
    explicit Ballot(std::size_t points, const Execution& execution = {});

    /// May be called from any number of threads.
    void cast(const Votes& votes);

    /// The weighted mean of the moves proposed for a point; zero where nobody voted.
    [[nodiscard]] Eigen::Vector3d outcome(std::size_t point) const;

private:
    std::unique_ptr<std::int64_t[]> sums_;  // four for each point
    std::vector<std::mutex> locks_;         // of so many points each
};

}  // namespace lpf
