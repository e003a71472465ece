#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lpf {

/// The codes alpha_j of all LPFs, d coefficients each, nearly all of them zero. Kept dense: d is
/// small, and the next iteration starts from them.
class SparseCodes {
public:
    SparseCodes() = default;
    SparseCodes(std::size_t fields, int atoms)
        : atoms_(atoms), values_(fields * static_cast<std::size_t>(atoms), 0.0F) {}

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

private:
    int atoms_ = 0;
    std::vector<float> values_;
};

}  // namespace lpf
