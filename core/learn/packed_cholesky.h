#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace lpf {

/// Lower Cholesky factor L of a growing and shrinking matrix of at most `Max` rows, rows packed one
/// after another. Lives on the stack and allocates nothing; only the rows in use are ever touched.
template <std::size_t Max>
class PackedCholesky {
public:
    [[nodiscard]] std::size_t size() const { return size_; }

    /// Appends a row and column to the matrix. @param column size() entries @param diagonal its
    /// last
    /// @returns false, and changes nothing, where the new row depends linearly on the others
    bool append(const double* column, double diagonal) {
        double* row = factor_.data() + offset(size_);
        double pivot = diagonal;
        for (std::size_t i = 0; i < size_; ++i) {
            row[i] = column[i];
            const double* upper = factor_.data() + offset(i);
            for (std::size_t j = 0; j < i; ++j) row[i] -= upper[j] * row[j];
            row[i] /= upper[i];
            pivot -= row[i] * row[i];
        }
        if (!(pivot > kDependent * diagonal)) return false;
        row[size_++] = std::sqrt(pivot);
        return true;
    }

    /// Removes row and column k. Givens rotations make the rows below triangular again.
    void remove(std::size_t k) {
        std::array<double, Max> cosine;
        std::array<double, Max> sine;
        for (std::size_t i = k; i + 1 < size_; ++i) {
            const double* old = factor_.data() + offset(i + 1);
            double* row = factor_.data() + offset(i);
            for (std::size_t j = 0; j < k; ++j) row[j] = old[j];
            double carry = old[k];
            for (std::size_t j = k; j < i; ++j) {
                const double next = old[j + 1];
                row[j] = cosine[j] * carry + sine[j] * next;
                carry = cosine[j] * next - sine[j] * carry;
            }
            const double last = old[i + 1];
            row[i] = std::hypot(carry, last);
            cosine[i] = carry / row[i];
            sine[i] = last / row[i];
        }
        --size_;
    }

    /// Solves L L' x = b in place. @param b size() entries
    void solve(double* b) const {
        for (std::size_t i = 0; i < size_; ++i) {
            const double* row = factor_.data() + offset(i);
            for (std::size_t j = 0; j < i; ++j) b[i] -= row[j] * b[j];
            b[i] /= row[i];
        }
        for (std::size_t i = size_; i-- > 0;) {
            const double* row = factor_.data() + offset(i);
            b[i] /= row[i];
            for (std::size_t j = 0; j < i; ++j) b[j] -= row[j] * b[i];
        }
    }

private:
    /// Share of its diagonal under which a pivot is rounding: the matrices hold float32 products.
    static constexpr double kDependent = 1e-6;

    static constexpr std::size_t offset(std::size_t row) { return row * (row + 1) / 2; }

    std::size_t size_ = 0;
    std::array<double, Max*(Max + 1) / 2> factor_;
};

}  // namespace lpf
