#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/aligned_floats.h"
#include "core/field/pattern.h"

namespace lpf {

/// D: d atoms, each a deformation field over one pattern (paper Eq. 2), in units of the radius.
/// An atom is three channels (x, y, z) of pattern.padded_size() floats, padding zero; its norm is
/// <= 1.
class Dictionary {
public:
    Dictionary(Pattern pattern, int atoms);

    [[nodiscard]] const Pattern& pattern() const { return pattern_; }
    [[nodiscard]] int atoms() const { return atoms_; }            ///< d
    [[nodiscard]] std::size_t stride() const { return stride_; }  ///< floats of an atom
    [[nodiscard]] std::span<float> atom(int k);
    [[nodiscard]] std::span<const float> atom(int k) const;
    [[nodiscard]] const float* data() const { return values_.data(); }

    /// out = D code. @param out stride() floats @param code atoms() coefficients
    void decode(std::span<const float> code, std::span<float> out) const;

    /// G = D'D: atoms() x atoms(), row-major.
    [[nodiscard]] std::vector<float> gram() const;

    /// D in panels (core/base/kernels.h).
    [[nodiscard]] AlignedFloats panels() const;

    /// D': stride() rows of whole_lines(d) floats, zeros behind the last atom; in panels.
    [[nodiscard]] AlignedFloats transposed_panels() const;

private:
    Pattern pattern_;
    int atoms_;
    std::size_t stride_;
    AlignedFloats values_;
};

/// What a round of coding leaves for the dictionary update: A = sum a a' and B = sum V a' (Mairal
/// et al. 2010, "Online learning for matrix factorization and sparse coding", algorithm 1).
class DictionaryStatistics {
public:
    DictionaryStatistics(int atoms, std::size_t stride);

    /// Adds fields of `stride` floats each and their codes, one behind the other.
    void add(std::span<const float> codes, std::span<const float> fields);
    void add(const DictionaryStatistics& other);

    /// One sweep of block coordinate descent over the atoms: lowers sum |V - D a|^2 with the codes
    /// fixed, norms kept <= 1. @returns the atoms that no code uses, which stay as they are
    std::vector<int> update(Dictionary& dictionary) const;

private:
    std::size_t atoms_;
    std::size_t stride_;
    AlignedFloats a_;  // d x d
    AlignedFloats b_;  // d x stride
};

/// Makes `field` an atom: scaled to norm 1; the zero field stays zero.
void set_atom(Dictionary& dictionary, int atom, std::span<const float> field);

}  // namespace lpf
