#pragma once

#include "core/consensus.h"
#include "core/field_set.h"
#include "core/resample.h"

namespace lpf {

/// The points that all LPFs propose (paper Eq. 7): the places of their patterns, moved by their
/// reconstructed fields, where the shape has points to support them. LPF by LPF, each from its
/// centre outwards.
/// @param spacing tau_p that the consensus will have [input length], > 0
[[nodiscard]] Candidates propose(const FieldSet& fields, const AnalysisResult& analysis,
                                 const ResampleParams& params, double spacing,
                                 const Execution& execution);

}  // namespace lpf
