#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/analysis.h"
#include "core/field_set.h"

namespace lpf {

/// The moves that LPFs propose for every point, summed: weight, and weighted move [radius]. In
/// fixed point, so that the order of the threads changes no digit.
class Ballot {
public:
    explicit Ballot(std::size_t points) : sums_(4 * points, 0) {}

    /// May be called from any number of threads.
    /// @param point in the order of the FieldSet's grid
    void vote(std::size_t point, float weight, const Eigen::Vector3f& move);

    /// The weighted mean of the moves proposed for a point; zero where nobody voted.
    [[nodiscard]] Eigen::Vector3d outcome(std::size_t point) const;

private:
    std::vector<std::int64_t> sums_;
};

using Moves = std::vector<Eigen::Vector3f>;

/// How LPFs vote.
struct VoteParams {
    bool sharp = false;  ///< weight by the cube of the representation error alone
    double noise = 0.0;  ///< standard deviation of the points off the shape [input length]
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
