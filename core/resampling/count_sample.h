#pragma once

#include <vector>

#include "core/resampling/proposals.h"

namespace lpf {

/// Foretells how many points a resampling has, from some places of the shape: the candidates of
/// cells spread all over it.
class CountSample {
public:
    /// @param spacing tau_p that is tried, roughly [input length]
    /// @param points  that it gives, roughly
    CountSample(const FieldSet& fields, const Proposer& proposer, double spacing, double points,
                const Execution& execution);

    /// Number of points of the whole shape, foretold by the areas of the LPFs.
    [[nodiscard]] double count(double spacing, const Execution& execution) const;

private:
    struct Part {
        Eigen::AlignedBox3d space;
        Candidates candidates;  // in it, and so far around that its border does not matter
    };

    std::vector<Part> parts_;
    double share_ = 1.0;  // of the parts in the whole shape
};

}  // namespace lpf
