#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/analysis.h"
#include "core/field_set.h"

namespace lpf {

using Moves = std::vector<Eigen::Vector3f>;

/// How LPFs vote.
struct VoteParams {
    bool sharp = false;  ///< weight by the cube of the representation error alone
    double noise = 0.0;  ///< standard deviation of the points off the shape [input length]
    bool slides = true;  ///< points beyond a border or an end are pulled to it
};

/// Every LPF proposes a place for each point under its disk (paper Sec. 4.2). Departs from the
/// paper: a vote counts by the error that the LPF's piece promises, by how many of its points lie
/// there, and, where the noise is known, by how likely noise has moved a point so far: a second
/// round, from where the first has put the points, decides between parts of the shape that are
/// near.
/// @returns the move of each point, in the order of the grid [radius of the analysis]
[[nodiscard]] Moves vote(const FieldSet& fields, const AnalysisResult& analysis,
                         const VoteParams& params, const Execution& execution);

}  // namespace lpf
