#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace lpf {

/// Least squares of N unknowns, for R right-hand sides, summed in double.
template <int N, int R = 1>
class NormalEquations {
public:
    using Row = double[N];

    /// @param count of the rows that are summed elsewhere
    explicit NormalEquations(double count = 0) : count_(count) {}

    void set(int i, int j, double sum) { matrix_(i, j) = sum; }
    void set_right(int i, double sum) { right_(i, 0) = sum; }

    void add(const Row& row, const double (&value)[R]) {
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j <= i; ++j) matrix_(i, j) += row[i] * row[j];
            for (int r = 0; r < R; ++r) right_(i, r) += row[i] * value[r];
        }
        count_ += 1;
    }

    /// The same for `weight` equal rows of one value.
    void add_weighted(const Row& row, double value, double weight) {
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j <= i; ++j) matrix_(i, j) += weight * row[i] * row[j];
            right_(i, 0) += weight * row[i] * value;
        }
        count_ += weight;
    }

    /// Draws unknown i towards zero with the weight of this share of all rows.
    void damp(int i, double share) { matrix_(i, i) += share * (count_ > 1 ? count_ : 1); }

    [[nodiscard]] Eigen::LDLT<Eigen::Matrix<double, N, N>> decomposed() const {
        return Eigen::LDLT<Eigen::Matrix<double, N, N>>(matrix_);
    }
    [[nodiscard]] const Eigen::Matrix<double, N, R>& right() const { return right_; }
    [[nodiscard]] double count() const { return count_; }

    [[nodiscard]] Eigen::Matrix<double, N, R> solve() const { return decomposed().solve(right_); }

private:
    Eigen::Matrix<double, N, N> matrix_ = Eigen::Matrix<double, N, N>::Zero();  // lower half
    Eigen::Matrix<double, N, R> right_ = Eigen::Matrix<double, N, R>::Zero();
    double count_;
};

}  // namespace lpf
