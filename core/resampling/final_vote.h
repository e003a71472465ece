#pragma once

#include <cstddef>

#include "core/analysis.h"
#include "core/field_set.h"
#include "core/resampling/consensus.h"

namespace lpf {

/// All LPFs vote on the points of a resampling, as they do on those of a cloud (paper Sec. 4.2),
/// and each point moves as they decide. Departs from the paper, which ends with the consensus: that
/// believes all LPFs alike, and averages less than the votes of those around. A point that is moved
/// far has been proposed by an LPF that the others do not agree with; it is dropped.
/// @param noise standard deviation of the noise that the shape had [input length], > 0
/// @param spacing of the points [input length]
void put_to_vote(const FieldSet& fields, const AnalysisResult& analysis, double noise,
                 double spacing, Candidates& points, const Execution& execution);

/// How far points are to be apart [input length].
struct Apart {
    double least = 0.0;      ///< of two nearer than that, one is dropped
    double wanted = 0.0;     ///< the same, as long as there are enough points
    std::size_t enough = 0;  ///< number of points
};

/// Drops points that are too near to others, those of the nearest pairs first.
/// @returns a distance that no two points are nearer than [input length]
double spread_out(const Apart& apart, Candidates& points, const Execution& execution);

}  // namespace lpf
