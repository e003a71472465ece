#pragma once

#include "core/analysis.h"
#include "core/consensus.h"
#include "core/field_set.h"

namespace lpf {

/// All LPFs vote on the points of a resampling, as they do on those of a cloud (paper Sec. 4.2),
/// and each point moves as they decide. Departs from the paper, which ends with the consensus: that
/// believes all LPFs alike, and averages less than the votes of those around. A point that is moved
/// far has been proposed by an LPF that the others do not agree with; it is dropped.
/// @param noise standard deviation of the noise that the shape had [input length], > 0
/// @param spacing of the points [input length]
void put_to_vote(const FieldSet& fields, const AnalysisResult& analysis, double noise,
                 double spacing, Candidates& points, const Execution& execution);

/// Drops points so that no two are nearer than the spacing [input length].
void spread_out(double spacing, Candidates& points, const Execution& execution);

}  // namespace lpf
