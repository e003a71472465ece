#pragma once

#include <span>

namespace lpf {

/// Sparse coding of one field (paper Eq. 3): min over a of |V - D a|^2 + lambda |a|_1, without the
/// factor 1/2, on the Gram matrix G = D'D and the correlations c = D'V.
struct LassoProblem {
    std::span<const float> gram;          ///< d x d, row-major, symmetric
    std::span<const float> correlations;  ///< d
    float lambda = 0.0F;                  ///< >= 0
};

/// Cyclic coordinate descent from the code given (warm start), until no coefficient moves by more
/// than `tolerance`.
/// @param code d coefficients, in and out
/// @returns sweeps used
int solve_coordinate_descent(const LassoProblem& problem, std::span<float> code,
                             float tolerance = 1e-5F, int max_sweeps = 200);

/// Least angle regression with the LASSO modification (Efron et al. 2004; paper Sec. 3.3): the exact
/// solution on the path at lambda. Atoms that depend linearly on the active ones are passed over.
/// @param code d coefficients, out
void solve_lars(const LassoProblem& problem, std::span<float> code);

/// Least squares on the support of the code (its non-zero coefficients); others stay zero. Leaves
/// the code as it is where the support is singular.
void debias(const LassoProblem& problem, std::span<float> code);

/// a'Ga - 2 c'a + lambda |a|_1: Eq. 3 less the constant |V|^2.
[[nodiscard]] double lasso_objective(const LassoProblem& problem, std::span<const float> code);

}  // namespace lpf
