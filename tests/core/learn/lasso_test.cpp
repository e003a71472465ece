#include "core/learn/lasso.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

/// A coding problem made from a dictionary and a field that are known.
struct Instance {
    Eigen::MatrixXd atoms;  // m x d
    Eigen::VectorXd field;  // m
    std::vector<float> gram;
    std::vector<float> correlations;

    [[nodiscard]] LassoProblem at(float lambda) const { return {gram, correlations, lambda}; }
};

void measure(Instance& instance) {
    const Eigen::MatrixXf gram = (instance.atoms.transpose() * instance.atoms).cast<float>();
    const Eigen::VectorXf c = (instance.atoms.transpose() * instance.field).cast<float>();
    instance.gram.assign(gram.data(), gram.data() + gram.size());
    instance.correlations.assign(c.data(), c.data() + c.size());
}

/// Atoms of norm 1 that share a common part (0: nearly orthogonal; 3: nearly parallel), and a field
/// made of three of them and noise.
Instance make_instance(int d, double common, std::uint64_t seed) {
    Random random(seed);
    const int m = std::max(3 * d, 12);
    Instance instance{Eigen::MatrixXd(m, d), Eigen::VectorXd(m), {}, {}};
    Eigen::VectorXd shared(m);
    for (double& value : shared) value = random.normal();
    for (double& value : instance.atoms.reshaped()) value = random.normal();
    instance.atoms.colwise() += common * shared;
    instance.atoms.colwise().normalize();
    for (double& value : instance.field) value = 0.2 * random.normal();
    for (int i = 0; i < 3; ++i) {
        const auto atom = static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(d)));
        instance.field += 2 * random.normal() * instance.atoms.col(atom);
    }
    measure(instance);
    return instance;
}

std::vector<float> descend(const LassoProblem& problem, std::size_t d) {
    std::vector<float> code(d, 0.0F);
    solve_coordinate_descent(problem, code, 1e-6F, 5000);
    return code;
}

std::vector<float> lars(const LassoProblem& problem, std::size_t d) {
    std::vector<float> code(d, 7.0F);  // what was there must not matter
    solve_lars(problem, code);
    return code;
}

/// Largest violation of the optimality conditions of Eq. 3 as printed, without a factor 1/2:
/// |2 D'(V - D a)| <= lambda, and equal to lambda sign(a) where a is not zero.
double kkt_violation(const Instance& instance, float lambda, const std::vector<float>& code) {
    const Eigen::VectorXd a =
        Eigen::Map<const Eigen::VectorXf>(code.data(), std::ssize(code)).cast<double>();
    const Eigen::VectorXd slope =
        2 * instance.atoms.transpose() * (instance.field - instance.atoms * a);
    double worst = 0;
    for (Eigen::Index k = 0; k < a.size(); ++k) {
        const double violation = a[k] == 0 ? std::abs(slope[k]) - lambda
                                           : std::abs(slope[k] - std::copysign(lambda, a[k]));
        worst = std::max(worst, violation);
    }
    return worst;
}

struct Case {
    int d;
    double common;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.d << " atoms, common " << c.common; }

struct CaseName {
    std::string operator()(const testing::TestParamInfo<Case>& info) const {
        return std::to_string(info.param.d) + "AtomsCommon" +
               std::to_string(static_cast<int>(10 * info.param.common));
    }
};

constexpr float kLambdas[] = {0.001F, 0.05F, 0.2F, 1.0F, 3.0F};

class LassoOn : public testing::TestWithParam<Case> {
protected:
    template <typename Check>
    void for_each_problem(const Check& check) const {
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            const Instance instance = make_instance(GetParam().d, GetParam().common, seed);
            for (const float lambda : kLambdas) check(instance, lambda);
        }
    }
    const std::size_t d = static_cast<std::size_t>(GetParam().d);
};

TEST_P(LassoOn, CoordinateDescentMeetsTheOptimalityConditions) {
    for_each_problem([&](const Instance& instance, float lambda) {
        const auto code = descend(instance.at(lambda), d);
        ASSERT_LT(kkt_violation(instance, lambda, code), 2e-4) << "lambda " << lambda;
    });
}

TEST_P(LassoOn, LarsMeetsTheOptimalityConditions) {
    for_each_problem([&](const Instance& instance, float lambda) {
        const auto code = lars(instance.at(lambda), d);
        ASSERT_LT(kkt_violation(instance, lambda, code), 2e-4) << "lambda " << lambda;
    });
}

TEST_P(LassoOn, BothSolversReachTheSameObjective) {
    for_each_problem([&](const Instance& instance, float lambda) {
        const LassoProblem problem = instance.at(lambda);
        const double descended = lasso_objective(problem, descend(problem, d));
        const double exact = lasso_objective(problem, lars(problem, d));
        ASSERT_NEAR(descended, exact, 1e-6 * (1 + std::abs(exact))) << "lambda " << lambda;
    });
}

TEST_P(LassoOn, ZeroLambdaIsLeastSquares) {
    const Instance instance = make_instance(GetParam().d, GetParam().common, 3);
    const Eigen::VectorXd best = (instance.atoms.transpose() * instance.atoms)
                                     .ldlt()
                                     .solve(instance.atoms.transpose() * instance.field);
    const double least = (instance.field - instance.atoms * best).squaredNorm();
    const auto residual = [&](const std::vector<float>& code) {
        const Eigen::VectorXd a =
            Eigen::Map<const Eigen::VectorXf>(code.data(), std::ssize(code)).cast<double>();
        return (instance.field - instance.atoms * a).squaredNorm();
    };
    EXPECT_NEAR(residual(descend(instance.at(0), d)), least, 1e-5 * (1 + least));
    EXPECT_NEAR(residual(lars(instance.at(0), d)), least, 1e-5 * (1 + least));
}

TEST_P(LassoOn, CodeIsZeroFromTwiceTheLargestCorrelationOn) {
    const Instance instance = make_instance(GetParam().d, GetParam().common, 4);
    float largest = 0;
    for (const float c : instance.correlations) largest = std::max(largest, std::abs(c));
    const std::vector<float> zero(d, 0.0F);
    EXPECT_EQ(descend(instance.at(2.001F * largest), d), zero);
    EXPECT_EQ(lars(instance.at(2.001F * largest), d), zero);
    EXPECT_NE(descend(instance.at(1.999F * largest), d), zero);
    EXPECT_NE(lars(instance.at(1.999F * largest), d), zero);
}

TEST_P(LassoOn, WarmStartsReachWhatAColdStartReaches) {
    const Instance instance = make_instance(GetParam().d, GetParam().common, 5);
    const LassoProblem problem = instance.at(0.2F);
    const double cold = lasso_objective(problem, descend(problem, d));
    Random random(1);
    for (int trial = 0; trial < 5; ++trial) {
        std::vector<float> code(d);
        for (float& value : code) value = static_cast<float>(3 * random.normal());
        solve_coordinate_descent(problem, code, 1e-6F, 5000);
        EXPECT_NEAR(lasso_objective(problem, code), cold, 1e-6 * (1 + std::abs(cold)));
    }
}

TEST_P(LassoOn, DescentFromTheSolutionStaysThere) {
    const Instance instance = make_instance(GetParam().d, GetParam().common, 6);
    const LassoProblem problem = instance.at(0.3F);
    std::vector<float> code = lars(problem, d);
    const std::vector<float> solution = code;
    EXPECT_LE(solve_coordinate_descent(problem, code, 1e-4F), 3);
    for (std::size_t k = 0; k < d; ++k) EXPECT_NEAR(code[k], solution[k], 1e-3);
}

TEST_P(LassoOn, DebiasSolvesTheNormalEquationsOfTheSupport) {
    for_each_problem([&](const Instance& instance, float lambda) {
        std::vector<float> code = lars(instance.at(lambda), d);
        const std::vector<float> sparse = code;
        debias(instance.at(lambda), code);
        const Eigen::VectorXd a =
            Eigen::Map<const Eigen::VectorXf>(code.data(), std::ssize(code)).cast<double>();
        const Eigen::VectorXd slope =
            instance.atoms.transpose() * (instance.field - instance.atoms * a);
        for (std::size_t k = 0; k < d; ++k) {
            if (sparse[k] == 0) {
                ASSERT_EQ(code[k], 0);
            } else {
                ASSERT_NEAR(slope[static_cast<Eigen::Index>(k)], 0, 2e-4);
            }
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Sizes, LassoOn,
                         testing::Values(Case{1, 0}, Case{2, 0}, Case{2, 3}, Case{5, 1},
                                         Case{16, 0}, Case{16, 1}, Case{16, 3}, Case{31, 0.5},
                                         Case{64, 0}, Case{64, 2}),
                         CaseName());

TEST(Lasso, OneAtomIsSoftThresholdingByHalfLambda) {
    const std::vector<float> gram = {4.0F};
    for (const float c : {-3.0F, -0.5F, 0.0F, 0.4F, 2.0F}) {
        const std::vector<float> correlations = {c};
        const LassoProblem problem{gram, correlations, 1.0F};
        const float expected = std::copysign(std::max(std::abs(c) - 0.5F, 0.0F) / 4, c);
        EXPECT_FLOAT_EQ(descend(problem, 1)[0], expected);
        EXPECT_FLOAT_EQ(lars(problem, 1)[0], expected);
    }
}

TEST(Lasso, ObjectiveIsEquationThreeLessTheFieldsNorm) {
    const Instance instance = make_instance(8, 1, 7);
    const std::vector<float> code = {1.0F, -2.0F, 0, 0.5F, 0, 0, 0, 3.0F};
    const Eigen::VectorXd a = Eigen::Map<const Eigen::VectorXf>(code.data(), 8).cast<double>();
    const double equation = (instance.field - instance.atoms * a).squaredNorm() +
                            0.2 * a.lpNorm<1>() - instance.field.squaredNorm();
    EXPECT_NEAR(lasso_objective(instance.at(0.2F), code), equation, 1e-4);
}

TEST(Lasso, DuplicateAtomsDoNoHarm) {
    Instance instance = make_instance(12, 0.5, 8);
    const Instance plain = instance;
    instance.atoms.conservativeResize(Eigen::NoChange, 18);
    instance.atoms.rightCols(6) = instance.atoms.leftCols(6);
    instance.atoms.col(15) *= -1;
    measure(instance);
    for (const float lambda : kLambdas) {
        const double expected = lasso_objective(plain.at(lambda), lars(plain.at(lambda), 12));
        for (const auto& code : {descend(instance.at(lambda), 18), lars(instance.at(lambda), 18)}) {
            EXPECT_NEAR(lasso_objective(instance.at(lambda), code), expected,
                        1e-5 * (1 + std::abs(expected)));
            EXPECT_LT(kkt_violation(instance, lambda, code), 1e-3);
        }
    }
}

TEST(Lasso, AtomsOfNormZeroGetNoCoefficient) {
    Instance instance = make_instance(6, 0, 9);
    instance.atoms.col(2).setZero();
    measure(instance);
    std::vector<float> code(6, 5.0F);
    solve_coordinate_descent(instance.at(0.0F), code);
    EXPECT_EQ(code[2], 0);
    EXPECT_EQ(lars(instance.at(0.0F), 6)[2], 0);
    EXPECT_TRUE(std::isfinite(lasso_objective(instance.at(0.0F), code)));
}

TEST(Lasso, AZeroFieldHasTheZeroCode) {
    Instance instance = make_instance(10, 1, 10);
    instance.field.setZero();
    measure(instance);
    for (const float lambda : {0.0F, 0.5F}) {
        EXPECT_EQ(lars(instance.at(lambda), 10), std::vector<float>(10, 0.0F));
        EXPECT_EQ(descend(instance.at(lambda), 10), std::vector<float>(10, 0.0F));
    }
}

TEST(Lasso, LarsFollowsThePathThroughDrops) {
    // As lambda falls, an atom enters and leaves again: the sizes of the supports are not monotone.
    bool dropped = false;
    for (std::uint64_t seed = 0; seed < 40 && !dropped; ++seed) {
        const Instance instance = make_instance(10, 2, 100 + seed);
        std::vector<float> previous(10, 0.0F);
        for (float lambda = 6; lambda > 0.01F; lambda *= 0.95F) {
            const std::vector<float> code = lars(instance.at(lambda), 10);
            ASSERT_LT(kkt_violation(instance, lambda, code), 2e-4);
            for (std::size_t k = 0; k < 10; ++k) dropped |= previous[k] != 0 && code[k] == 0;
            previous = code;
        }
    }
    EXPECT_TRUE(dropped) << "no instance exercises the drop";
}

TEST(Lasso, RespectsTheLimitOnSweeps) {
    const Instance instance = make_instance(32, 3, 11);
    std::vector<float> code(32, 0.0F);
    EXPECT_LE(solve_coordinate_descent(instance.at(0.01F), code, 0.0F, 7), 7);
    EXPECT_LT(lasso_objective(instance.at(0.01F), code), 0) << "it must have come down from zero";
}

TEST(Lasso, FieldsCodedTogetherGetTheCodesThatTheyGetAlone) {
    constexpr std::size_t kAtoms = 20;
    const Instance instance = make_instance(kAtoms, 1, 15);
    for (const std::size_t fields : {0U, 2U, 8U, 19U}) {
        std::vector<std::vector<float>> correlations(fields, instance.correlations);
        std::vector<std::vector<float>> codes(fields, std::vector<float>(kAtoms, 0.0F));
        std::vector<LassoTask> tasks;
        for (std::size_t i = 0; i < fields; ++i) {
            std::ranges::rotate(correlations[i], correlations[i].begin() + std::ptrdiff_t(i));
            codes[i][i] = 1.0F;
            tasks.push_back({correlations[i], 0.1F * static_cast<float>(i + 1), codes[i]});
        }
        solve_coordinate_descent(instance.gram, tasks);
        for (std::size_t i = 0; i < fields; ++i) {
            std::vector<float> alone(kAtoms, 0.0F);
            alone[i] = 1.0F;
            solve_coordinate_descent({instance.gram, correlations[i], tasks[i].lambda}, alone);
            EXPECT_EQ(codes[i], alone) << "field " << i << " of " << fields;
        }
    }
}

TEST(Lasso, TakesTheLargestDictionary) {
    const auto d = static_cast<int>(kMaxAtoms);
    const Instance instance = make_instance(d, 0.5, 12);
    const LassoProblem problem = instance.at(0.5F);
    const double exact = lasso_objective(problem, lars(problem, kMaxAtoms));
    EXPECT_NEAR(lasso_objective(problem, descend(problem, kMaxAtoms)), exact,
                1e-5 * (1 + std::abs(exact)));
}

TEST(Debias, LeavesASingularSupportAlone) {
    Instance instance = make_instance(4, 0, 13);
    instance.atoms.col(3) = instance.atoms.col(0);
    measure(instance);
    std::vector<float> code = {1.0F, 0.0F, 0.0F, 0.5F};
    const std::vector<float> before = code;
    debias(instance.at(0.1F), code);
    EXPECT_EQ(code, before);
}

TEST(Debias, LeavesTheEmptySupportEmpty) {
    const Instance instance = make_instance(4, 0, 14);
    std::vector<float> code(4, 0.0F);
    debias(instance.at(0.1F), code);
    EXPECT_EQ(code, std::vector<float>(4, 0.0F));
}

TEST(Lasso, TakesAtomsOfAnyNorm) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        Instance instance = make_instance(8, 0.5, seed);
        for (Eigen::Index k = 0; k < 8; ++k) {
            instance.atoms.col(k) *= 0.3 + 0.2 * static_cast<double>(k);
        }
        measure(instance);
        for (const float lambda : kLambdas) {
            EXPECT_LT(kkt_violation(instance, lambda, descend(instance.at(lambda), 8)), 1e-3);
            EXPECT_LT(kkt_violation(instance, lambda, lars(instance.at(lambda), 8)), 1e-3);
        }
    }
}

}  // namespace
}  // namespace lpf
