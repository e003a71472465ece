#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/aligned_floats.h"
#include "core/base/parallel.h"
#include "core/learn/dictionary.h"
#include "core/learn/lasso.h"
#include "core/learn/sparse_code.h"

namespace lpf {

/// What fields are coded with, made once for all of them.
struct CodingMatrices {
    explicit CodingMatrices(const Dictionary& dictionary);
    std::vector<float> gram;   ///< G = D'D: d x d
    AlignedFloats atoms;       ///< D, in panels: d x stride
    AlignedFloats transposed;  ///< D', in panels: stride x width, zeros behind the last atom
    std::size_t stride;
    std::size_t width;  ///< of the correlations of one field: whole_lines(d)
    std::size_t d;
};

/// How fields are turned into codes (paper Eq. 3 with the dictionary fixed).
struct Coder {
    float lambda = 0.2F;
    LassoMethod method = LassoMethod::CoordinateDescent;

    /// @param code         in: where to start from; out: the sparse code of `field`
    /// @param lambda_share factor on lambda for this field, > 0
    void encode(const CodingMatrices& matrices, std::span<const float> field, std::span<float> code,
                float lambda_share = 1.0F) const;

    /// What it takes, for several fields at once: c = D'V, matrices.width values for each; and the
    /// codes.
    static void correlate(const CodingMatrices& matrices, std::span<const float> fields,
                          std::span<float> correlations);
    void solve(std::span<const float> gram, std::span<const LassoTask> tasks) const;

    /// D alpha of several codes, one behind the other.
    static void decode(const CodingMatrices& matrices, std::span<const float> codes,
                       std::span<float> out);
};

/// Fields that are coded together: enough that the dictionary is read once for all of them, few
/// enough to stay in the first cache themselves.
inline constexpr std::size_t kFieldsOfBlock = 8;

/// Some LPFs' fields, side by side: `count` x stride floats.
struct FieldSample {
    AlignedFloats fields;
    std::size_t stride = 0;
    std::vector<float> lambda_share = {};  ///< factor on lambda of each; empty = 1 for all
    [[nodiscard]] std::size_t count() const { return stride ? fields.size() / stride : 0; }
    [[nodiscard]] std::span<const float> operator[](std::size_t i) const { return some(i, 1); }
    [[nodiscard]] float share_of(std::size_t i) const {
        return lambda_share.empty() ? 1.0F : lambda_share[i];
    }
    /// n fields from number i on.
    [[nodiscard]] std::span<const float> some(std::size_t i, std::size_t n) const {
        return {fields.data() + i * stride, n * stride};
    }
};

/// A dictionary of randomly drawn fields (paper Sec. 3.3), each with norm 1.
[[nodiscard]] Dictionary draw_dictionary(const Pattern& pattern, int atoms,
                                         const FieldSample& sample, std::uint64_t random_seed);

/// Alternates sparse coding and dictionary update on the sample (paper Sec. 3.3). Neither step
/// raises the energy of the sample. Atoms that nothing uses are drawn anew from the sample.
/// @param codes count x d; in: where to start from, out: codes for the learned dictionary
void learn_dictionary(const FieldSample& sample, const Coder& coder, int rounds,
                      std::uint64_t random_seed, Dictionary& dictionary, SparseCodes& codes,
                      const Execution& execution);

}  // namespace lpf
