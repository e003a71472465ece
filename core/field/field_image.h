#pragma once

#include <vector>

#include "core/field/pattern.h"

namespace lpf {

/// A deformation field that can be read between the nodes of its pattern: bilinearly on a grid, by
/// the stencils of the pattern otherwise.
class FieldImage {
public:
    explicit FieldImage(const Pattern& pattern);

    /// @param field three channels of pattern.padded_size() floats
    void assign(const float* field);

    /// The displacements at n places, in units of the radius. @param out three arrays of n floats
    void read(const float* x, const float* y, std::size_t n, float* const out[3]) const;

private:
    void read_by_stencils(const float* x, const float* y, std::size_t n, float* const out[3]) const;

    const Pattern& pattern_;
    std::vector<float> values_;  // of a grid: four at each place; else the field itself
};

}  // namespace lpf
