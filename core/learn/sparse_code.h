#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lpf {

/// The codes alpha_j of all LPFs, d coefficients each, nearly all of them zero. Kept dense: d is
/// small, and the next iteration starts from them.
class SparseCodes {
public:
    SparseCodes() = default;
    SparseCodes(std::size_t fields, int atoms)
        : atoms_(atoms), values_(fields * static_cast<std::size_t>(atoms), 0.0F) {}

    /// @param values of d coefficients each, one LPF behind the other
    SparseCodes(std::vector<float> values, int atoms) : atoms_(atoms), values_(std::move(values)) {}

    [[nodiscard]] const std::vector<float>& values() const { return values_; }
    [[nodiscard]] int atoms() const { return atoms_; }
    [[nodiscard]] std::size_t size() const {
        return atoms_ ? values_.size() / static_cast<std::size_t>(atoms_) : 0;
    }
    [[nodiscard]] std::span<float> operator[](std::size_t field) {
        return {values_.data() + field * static_cast<std::size_t>(atoms_),
                static_cast<std::size_t>(atoms_)};
    }
    [[nodiscard]] std::span<const float> operator[](std::size_t field) const {
        return {values_.data() + field * static_cast<std::size_t>(atoms_),
                static_cast<std::size_t>(atoms_)};
    }
    /// Those of n LPFs from number j on.
    [[nodiscard]] std::span<const float> some(std::size_t j, std::size_t n) const {
        const auto d = static_cast<std::size_t>(atoms_);
        return {values_.data() + j * d, n * d};
    }

private:
    int atoms_ = 0;
    std::vector<float> values_;
};

/// The share of the codes that use each atom, 0 to 1.
[[nodiscard]] inline std::vector<float> usage_of_atoms(const SparseCodes& codes) {
    std::vector<float> usage(static_cast<std::size_t>(codes.atoms()), 0.0F);
    for (std::size_t j = 0; j < codes.size(); ++j) {
        for (std::size_t k = 0; k < usage.size(); ++k)
            usage[k] += codes[j][k] != 0.0F ? 1.0F : 0.0F;
    }
    for (float& share : usage) share /= static_cast<float>(std::max<std::size_t>(1, codes.size()));
    return usage;
}

}  // namespace lpf
