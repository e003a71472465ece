#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/analysis.h"
#include "core/base/aligned_floats.h"
#include "core/field_set.h"
#include "core/learn/dictionary_learning.h"

namespace lpf {

/// What LPFs go through one iteration of the joint loop with.
struct Iteration {
    std::shared_ptr<const CodingMatrices> matrices;  ///< none where no iteration was yet
    int number = -1;                                 ///< from 0; -1 where none was yet
    bool closes = false;  ///< LPFs stay, and their codes are the last ones
};

/// LPFs that are worked on side by side, as many as there are numbers.
struct FieldBlock {
    std::span<const std::size_t> number;  ///< of each in the set
    std::span<float> fields;              ///< V_j, one behind the other
    std::span<float> decoded;             ///< D alpha_j, alike
    std::span<float> correlations;        ///< whole_lines(d) for each
    std::span<float> codes;               ///< d for each

    [[nodiscard]] std::size_t count() const { return number.size(); }
    [[nodiscard]] std::span<float> field(std::size_t i) const { return part(fields, i); }
    [[nodiscard]] std::span<float> decoded_field(std::size_t i) const { return part(decoded, i); }

private:
    [[nodiscard]] std::span<float> part(std::span<float> all, std::size_t i) const {
        const std::size_t size = all.size() / count();
        return all.subspan(i * size, size);
    }
};

/// What a thread needs to work on one block after the other.
class BlockRoom {
public:
    /// @param stride floats of a field  @param d atoms
    BlockRoom(std::size_t stride, std::size_t d);

    /// @param fields those of the LPFs, or room for them
    [[nodiscard]] FieldBlock block(std::span<const std::size_t> numbers, std::span<float> fields);

private:
    AlignedFloats decoded_, correlations_, codes_;  // of kFieldsOfBlock LPFs
};

/// The steps of the joint loop for blocks of LPFs (paper Sec. 3.2), and what they leave. Any number
/// of threads may work on different LPFs.
class JointSteps {
public:
    /// @param fields, params must outlive this; poses change
    JointSteps(FieldSet& fields, const AnalysisParams& params, int atoms);

    /// Step 3, the end of an iteration: the LPFs are probed where they now are.
    void close(const Iteration& last, const FieldBlock& block, IterationEnergy& sum) const;

    /// Steps 1 and 2: they are coded, and move to where they fit their codes best.
    void iterate(const Iteration& iteration, const FieldBlock& block, IterationEnergy& sum);

    [[nodiscard]] const Coder& coder() const { return coder_; }

    SparseCodes codes;             ///< N x d
    std::vector<float> residuals;  ///< of each LPF, after the last iteration [radius]

private:
    void decode(const CodingMatrices& matrices, const FieldBlock& block) const;
    void encode(const CodingMatrices& matrices, const FieldBlock& block);
    void move_to_fit(const FieldBlock& block, std::size_t i);
    void finish(const Iteration& iteration, const FieldBlock& block);
    [[nodiscard]] double energy(const FieldBlock& block, std::size_t i) const;

    FieldSet& fields_;
    const AnalysisParams& params_;
    Coder coder_;
};

}  // namespace lpf
