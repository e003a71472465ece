#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// Points that LPFs propose for a resampling, in the order in which they are to be considered.
struct Candidates {
    Points points;                     ///< 3 x K [input length]
    std::vector<std::uint32_t> field;  ///< K, the LPF that proposes each

    [[nodiscard]] std::size_t size() const { return field.size(); }
};

/// A consensus of the candidates (paper Sec. 4.1, Eq. 8), found greedily in their order: the mean
/// of all candidates within `spacing` of one becomes a point, unless one is that near already, and
/// all candidates within `spacing` of it are spent. No two points are nearer than `spacing`.
/// Departs from the text, which bounds a length by tau_p squared.
/// @param spacing tau_p [input length], > 0
/// @returns the points, each with the LPF that proposed it first
[[nodiscard]] Candidates find_consensus(const Candidates& candidates, double spacing,
                                        const Execution& execution);

}  // namespace lpf
