#include "core/denoising/ballot.h"

#include <algorithm>

#include "core/base/vote_kernels.h"

namespace lpf {
namespace {

constexpr std::uint32_t kPointsPerLock = 4096;

constexpr float kFixedPoint = 4294967296.0F;  // 2^32
constexpr float kLeastWeight = 0x1p-20F;
constexpr float kLargestWeight = 0x1p10F;

}  // namespace

Ballot::Ballot(std::size_t points, const Execution& execution)
    : sums_(std::make_unique_for_overwrite<std::int64_t[]>(4 * points)),
      locks_(points / kPointsPerLock + 1) {
    // Memory is handed out as it is first written: by all threads, not by one.
    parallel_for(execution, points, kPointsPerLock,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     std::fill(&sums_[4 * begin], &sums_[4 * end], 0);
                 });
}

void Ballot::cast(const Votes& votes) {
    for (std::size_t begin = 0, end = 0; begin < votes.point.size(); begin = end) {
        const std::uint32_t lock = votes.point[begin] / kPointsPerLock;
        while (end < votes.point.size() && votes.point[end] / kPointsPerLock == lock) ++end;
        const std::scoped_lock locked(locks_[lock]);
        kernels::add_votes(votes.point.data() + begin, votes.weight.data() + begin,
                           votes.move[0] + begin, votes.move[1] + begin, votes.move[2] + begin,
                           end - begin, kFixedPoint, kLeastWeight, kLargestWeight, sums_.get());
    }
}

Eigen::Vector3d Ballot::outcome(std::size_t point) const {
    const std::int64_t* sums = sums_.get() + 4 * point;
    if (sums[0] == 0) return Eigen::Vector3d::Zero();
    return Eigen::Vector3d(static_cast<double>(sums[1]), static_cast<double>(sums[2]),
                           static_cast<double>(sums[3])) /
           static_cast<double>(sums[0]);
}

}  // namespace lpf
