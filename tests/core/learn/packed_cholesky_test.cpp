#include "core/learn/packed_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

constexpr Eigen::Index kSize = 12;

Eigen::MatrixXd positive_matrix() {
    Random random(1);
    Eigen::MatrixXd a(kSize + 3, kSize);
    for (double& value : a.reshaped()) value = random.normal();
    return a.transpose() * a;
}

bool append(PackedCholesky<kSize>& factor, const Eigen::MatrixXd& matrix,
            const std::vector<Eigen::Index>& rows, Eigen::Index row) {
    std::vector<double> column;
    for (const Eigen::Index i : rows) column.push_back(matrix(i, row));
    return factor.append(column.data(), matrix(row, row));
}

void expect_solves(const PackedCholesky<kSize>& factor, const Eigen::MatrixXd& matrix,
                   const std::vector<Eigen::Index>& rows) {
    const Eigen::MatrixXd part = matrix(rows, rows);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(std::ssize(rows), -1, 2);
    Eigen::VectorXd x = b;
    factor.solve(x.data());
    EXPECT_LT((part * x - b).norm(), 1e-9) << rows.size() << " rows";
}

TEST(PackedCholesky, SolvesAfterEveryAppend) {
    const Eigen::MatrixXd matrix = positive_matrix();
    PackedCholesky<kSize> factor;
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < kSize; ++i) {
        ASSERT_TRUE(append(factor, matrix, rows, i));
        rows.push_back(i);
        ASSERT_EQ(factor.size(), rows.size());
        expect_solves(factor, matrix, rows);
    }
}

TEST(PackedCholesky, SolvesAfterEveryRemoval) {
    const Eigen::MatrixXd matrix = positive_matrix();
    PackedCholesky<kSize> factor;
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = 0; i < kSize; ++i) {
        ASSERT_TRUE(append(factor, matrix, rows, i));
        rows.push_back(i);
    }
    Random random(2);
    while (rows.size() > 1) {
        const std::size_t k = random.below(rows.size());
        factor.remove(k);
        rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(k));
        expect_solves(factor, matrix, rows);
    }
}

TEST(PackedCholesky, RefusesARowThatDependsOnTheOthers) {
    Eigen::MatrixXd matrix(2, 2);
    matrix << 4, 2, 2, 1;
    PackedCholesky<kSize> factor;
    ASSERT_TRUE(append(factor, matrix, {}, 0));
    EXPECT_FALSE(append(factor, matrix, {0}, 1));
    EXPECT_EQ(factor.size(), 1U);
    expect_solves(factor, matrix, {0});
}

}  // namespace
}  // namespace lpf
