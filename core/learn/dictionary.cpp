#include "core/learn/dictionary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/kernels.h"
#include "core/learn/lasso.h"

namespace lpf {
namespace {

/// The part of a code that counts.
struct NonZero {
    std::array<unsigned, kMaxAtoms> atom;
    std::array<float, kMaxAtoms> coefficient;
    std::size_t count = 0;

    explicit NonZero(std::span<const float> code) {  // arrays are filled as far as they are used
        for (std::size_t k = 0; k < code.size(); ++k) {
            if (code[k] == 0.0F) continue;
            atom[count] = static_cast<unsigned>(k);
            coefficient[count++] = code[k];
        }
    }
};

/// Columns of rows x n values, each with zeros behind it up to `padded` values.
AlignedFloats transpose(const float* values, std::size_t rows, std::size_t n, std::size_t padded) {
    AlignedFloats columns(n * padded, 0.0F);
    for (std::size_t i = 0; i < rows; ++i) {
        for (std::size_t k = 0; k < n; ++k) columns[k * padded + i] = values[i * n + k];
    }
    return columns;
}

AlignedFloats in_panels(const AlignedFloats& values, std::size_t rows, std::size_t n) {
    AlignedFloats panels(values.size());
    kernels::to_panels(values.data(), rows, n, panels.data());
    return panels;
}

}  // namespace

Dictionary::Dictionary(Pattern pattern, int atoms)
    : pattern_(std::move(pattern)),
      atoms_(atoms),
      stride_(3 * static_cast<std::size_t>(pattern_.padded_size())),
      values_(stride_ * static_cast<std::size_t>(atoms), 0.0F) {}

std::span<float> Dictionary::atom(int k) {
    return {values_.data() + static_cast<std::size_t>(k) * stride_, stride_};
}

std::span<const float> Dictionary::atom(int k) const {
    return {values_.data() + static_cast<std::size_t>(k) * stride_, stride_};
}

void Dictionary::decode(std::span<const float> code, std::span<float> out) const {
    const NonZero used(code);
    kernels::combine_rows(data(), stride_, stride_, used.atom.data(), used.coefficient.data(),
                          used.count, out.data());
}

std::vector<float> Dictionary::gram() const {
    const auto d = static_cast<std::size_t>(atoms_);
    std::vector<float> gram(d * d);
    for (std::size_t k = 0; k < d; ++k) {
        for (std::size_t l = 0; l <= k; ++l) {
            gram[k * d + l] = gram[l * d + k] =
                kernels::dot(data() + k * stride_, data() + l * stride_, stride_);
        }
    }
    return gram;
}

AlignedFloats Dictionary::panels() const {
    return in_panels(values_, static_cast<std::size_t>(atoms_), stride_);
}

AlignedFloats Dictionary::transposed_panels() const {
    const auto d = static_cast<std::size_t>(atoms_);
    const std::size_t width = whole_lines(d);
    return in_panels(transpose(data(), d, stride_, width), stride_, width);
}

DictionaryStatistics::DictionaryStatistics(int atoms, std::size_t stride)
    : atoms_(static_cast<std::size_t>(atoms)),
      stride_(stride),
      a_(atoms_ * atoms_, 0.0F),
      b_(atoms_ * stride, 0.0F) {}

void DictionaryStatistics::add(std::span<const float> codes, std::span<const float> fields) {
    const std::size_t count = fields.size() / stride_;
    const AlignedFloats of_atoms = transpose(codes.data(), count, atoms_, count);
    kernels::add_product(of_atoms.data(), atoms_, count, codes.data(), atoms_, a_.data());
    kernels::add_product(of_atoms.data(), atoms_, count, fields.data(), stride_, b_.data());
}

void DictionaryStatistics::add(const DictionaryStatistics& other) {
    kernels::add_scaled(1.0F, other.a_.data(), a_.data(), a_.size());
    kernels::add_scaled(1.0F, other.b_.data(), b_.data(), b_.size());
}

std::vector<int> DictionaryStatistics::update(Dictionary& dictionary) const {
    std::vector<int> unused;
    std::vector<float> step(stride_);
    for (std::size_t k = 0; k < atoms_; ++k) {
        const float weight = a_[k * atoms_ + k];
        if (weight < 1e-12F) {
            unused.push_back(static_cast<int>(k));
            continue;
        }
        std::copy_n(b_.data() + k * stride_, stride_, step.begin());
        for (std::size_t j = 0; j < atoms_; ++j) {
            const float shared = a_[k * atoms_ + j];
            if (shared == 0.0F) continue;
            kernels::add_scaled(-shared, dictionary.data() + j * stride_, step.data(), stride_);
        }
        const std::span<float> atom = dictionary.atom(static_cast<int>(k));
        kernels::add_scaled(1.0F / weight, step.data(), atom.data(), stride_);
        const float norm = std::sqrt(kernels::dot(atom.data(), atom.data(), stride_));
        if (norm > 1.0F) {
            for (float& value : atom) value /= norm;
        }
    }
    return unused;
}

void set_atom(Dictionary& dictionary, int atom, std::span<const float> field) {
    const float norm = std::sqrt(kernels::dot(field.data(), field.data(), field.size()));
    const float scale = norm > 0 ? 1 / norm : 0.0F;
    std::transform(field.begin(), field.end(), dictionary.atom(atom).begin(),
                   [scale](float value) { return scale * value; });
}

}  // namespace lpf
