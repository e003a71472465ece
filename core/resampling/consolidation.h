#pragma once

#include <optional>

#include "core/resampling/consensus.h"
#include "core/resampling/proposals.h"

namespace lpf {

/// From LPFs to points that are tau_p apart (paper Sec. 4.1), in little memory: the candidates of a
/// part of the shape are gone before those of the next are made.
class Consolidation {
public:
    struct Found {
        Consensus consensus;
        double spacing = 0.0;  ///< tau_p [input length]
    };

    /// @param fields, analysis, params must outlive it
    Consolidation(const FieldSet& fields, const AnalysisResult& analysis,
                  const ResampleParams& params)
        : fields_(fields), analysis_(analysis), params_(params) {}

    /// With the spacing that the parameters want, or about as many points as they do.
    [[nodiscard]] Found find(const Execution& execution);

    /// With another spacing, which does not differ much. @pre find
    [[nodiscard]] Found find_again(double spacing, const Execution& execution) const;

private:
    [[nodiscard]] double guess_spacing() const;
    [[nodiscard]] bool is_small() const;
    [[nodiscard]] Candidates all_candidates(const Execution& execution) const;
    [[nodiscard]] Consensus empty_consensus(double spacing) const;
    [[nodiscard]] Consensus pass(double spacing, const Execution& execution) const;
    [[nodiscard]] Found search_on_all(double guess, const Execution& execution) const;
    [[nodiscard]] Found search_on_sample(double guess, const Execution& execution) const;

    const FieldSet& fields_;
    const AnalysisResult& analysis_;
    const ResampleParams& params_;
    std::optional<Proposer> proposer_;
};

}  // namespace lpf
