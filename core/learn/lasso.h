#pragma once

#include <cstddef>
#include <span>

namespace lpf {

/// Largest d that the solvers take: their work space is on the stack.
inline constexpr std::size_t kMaxAtoms = 256;

/// Which algorithm solves it; both give the same code.
enum class LassoMethod {
    CoordinateDescent,  ///< warm-started; the fast one
    Lars                ///< least angle regression, as in the paper (Sec. 3.3)
};

/// Sparse coding of one field (paper Eq. 3): min over a of |V - D a|^2 + lambda |a|_1, without the
/// factor 1/2, on the Gram matrix G = D'D and the correlations c = D'V.
/// At the solution |2 (c - G a)_k| <= lambda, with equality (and the sign of a_k) where a_k != 0.
struct LassoProblem {
    std::span<const float> gram;          ///< d x d, row-major, symmetric
    std::span<const float> correlations;  ///< d
    float lambda = 0.0F;                  ///< >= 0
};

/// Coordinate descent from the code given (warm start), until no coefficient would move by more
/// than `tolerance`; where correlated atoms slow it down, exact steps on the active atoms help it
/// along. Atoms of norm 0 get the coefficient 0.
/// @param code d coefficients, in and out, d <= kMaxAtoms
/// @returns sweeps used, over the coefficients that moved
int solve_coordinate_descent(const LassoProblem& problem, std::span<float> code,
                             float tolerance = 1e-5F, int max_sweeps = 200);

/// A field to be coded with the Gram matrix that it shares with others.
struct LassoTask {
    std::span<const float> correlations;  ///< d
    float lambda = 0.0F;                  ///< >= 0
    std::span<float> code;                ///< d coefficients, in and out, d <= kMaxAtoms
};

/// The same for several fields, faster than one by one; no code depends on the others.
/// @returns the most sweeps that any took
int solve_coordinate_descent(std::span<const float> gram, std::span<const LassoTask> tasks,
                             float tolerance = 1e-5F, int max_sweeps = 200);

/// Least angle regression with the LASSO modification (Efron et al. 2004; paper Sec. 3.3): the
/// exact solution on the path at lambda. Atoms that depend linearly on the active ones are passed
/// over.
/// @param code d coefficients, out, d <= kMaxAtoms
void solve_lars(const LassoProblem& problem, std::span<float> code);

/// Least squares on the support of the code (its non-zero coefficients); others stay zero. Leaves
/// the code as it is where the support is singular.
/// @param code d coefficients, in and out, d <= kMaxAtoms
void debias(const LassoProblem& problem, std::span<float> code);

/// a'Ga - 2 c'a + lambda |a|_1: Eq. 3 less the constant |V|^2.
[[nodiscard]] double lasso_objective(const LassoProblem& problem, std::span<const float> code);

}  // namespace lpf
