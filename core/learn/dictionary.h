#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/field/pattern.h"

namespace lpf {

/// D: d atoms, each a deformation field over one pattern (paper Eq. 2), in units of the radius.
/// An atom is three channels (x, y, z) of pattern.padded_size() floats, padding zero; its norm is <= 1.
class Dictionary {
public:
    Dictionary(Pattern pattern, int atoms);

    [[nodiscard]] const Pattern& pattern() const { return pattern_; }
    [[nodiscard]] int atoms() const { return atoms_; }                       ///< d
    [[nodiscard]] std::size_t stride() const { return stride_; }             ///< floats of an atom
    [[nodiscard]] std::span<float> atom(int k);
    [[nodiscard]] std::span<const float> atom(int k) const;
    [[nodiscard]] const float* data() const { return values_.data(); }

    /// out = D code. @param out stride() floats @param code atoms() coefficients
    void decode(std::span<const float> code, std::span<float> out) const;

    /// G = D'D: atoms() x atoms(), row-major.
    [[nodiscard]] std::vector<float> gram() const;

private:
    Pattern pattern_;
    int atoms_;
    std::size_t stride_;
    std::vector<float> values_;
};

}  // namespace lpf
