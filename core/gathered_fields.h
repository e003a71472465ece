#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/field/probing.h"
#include "core/field_set.h"

namespace lpf {

/// Some LPFs whose points were gathered once, however often they are probed: poses change, centres
/// do not.
class GatheredFields {
public:
    /// @param set     must outlive this; its frames may change meanwhile
    /// @param numbers of the LPFs in the set
    GatheredFields(const FieldSet& set, std::span<const std::size_t> numbers);

    /// The field of LPF numbers[i] where it now is. @param field as FieldSet::probe
    void probe(std::size_t i, float* field);

private:
    const FieldSet& set_;
    std::span<const std::size_t> numbers_;
    NearPoints points_;               // of one LPF behind the other, relative to its centre
    std::vector<std::size_t> begin_;  // of each; beyond the last of these, they are not kept
    ProbeScratch scratch_;
};

}  // namespace lpf
