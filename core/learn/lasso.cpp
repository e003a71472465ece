#include "core/learn/lasso.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/kernels.h"
#include "core/learn/packed_cholesky.h"

namespace lpf {
namespace {

/// State of a descent: residual correlations r = c - G a are kept up to date, so that visiting an
/// atom costs O(1) unless its coefficient moves.
struct Descent {
    const float* gram;
    const float* correlations;
    std::size_t d;
    float threshold;  // lambda / 2, as Eq. 3 has no factor 1/2
    float* code;
    std::array<float, kMaxAtoms> residual;
    std::array<float, kMaxAtoms> diagonal;
    std::array<float, kMaxAtoms> inverse_diagonal;  // 0 for an atom of norm 0
};

/// Some of the atoms, in ascending order.
struct ActiveSet {
    std::array<unsigned, kMaxAtoms + 1> atom;
    std::size_t count = 0;
};

/// @returns the largest move
float sweep(Descent& descent, const ActiveSet& atoms) {
    return kernels::descent_sweep(descent.gram, descent.d, descent.threshold,
                                  descent.inverse_diagonal.data(), atoms.atom.data(), atoms.count,
                                  descent.code, descent.residual.data());
}

void find_non_zero(const Descent& descent, ActiveSet& active) {
    active.count = 0;
    for (std::size_t k = 0; k < descent.d; ++k) {
        active.atom[active.count] = static_cast<unsigned>(k);
        active.count += static_cast<std::size_t>(descent.code[k] != 0);
    }
}

/// The residual correlations of the code as it is.
void correlate(Descent& descent) {
    ActiveSet active;
    find_non_zero(descent, active);
    std::array<float, kMaxAtoms> coefficient;
    for (std::size_t i = 0; i < active.count; ++i) coefficient[i] = descent.code[active.atom[i]];
    kernels::combine_rows(descent.gram, descent.d, descent.d, active.atom.data(),
                          coefficient.data(), active.count, descent.residual.data());
    for (std::size_t k = 0; k < descent.d; ++k) {
        descent.residual[k] = descent.correlations[k] - descent.residual[k];
    }
}

void start(Descent& descent) {
    for (std::size_t k = 0; k < descent.d; ++k) {
        const float diagonal = descent.gram[k * descent.d + k];
        descent.diagonal[k] = diagonal;
        descent.inverse_diagonal[k] = diagonal > 0 ? 1 / diagonal : 0;
        if (!(diagonal > 0)) descent.code[k] = 0;
    }
    correlate(descent);
}

/// Where correlated atoms make the sweeps crawl: with the signs held, Eq. 3 is a quadratic, so walk
/// straight to its minimum, or to the first coefficient that reaches zero on the way. Atoms that
/// depend linearly on those before them stay where they are.
void jump_to_minimum(Descent& descent) {
    ActiveSet active;
    find_non_zero(descent, active);
    const std::size_t n = active.count;
    const std::size_t stride = kernels::padded_row(n);
    std::array<double, kernels::room_to_solve(kMaxAtoms)> matrix;  // only what is used is touched
    std::array<double, kMaxAtoms> step;
    for (std::size_t i = 0; i < n; ++i) {
        const unsigned k = active.atom[i];
        const float* row = descent.gram + k * descent.d;
        double* to = matrix.data() + i * stride;
        for (std::size_t j = i; j < n; ++j) to[j] = row[active.atom[j]];
        to[n] = descent.residual[k] - std::copysign(descent.threshold, descent.code[k]);
        std::fill(to + n + 1, to + stride, 0.0);
    }
    kernels::solve_definite(matrix.data(), n, step.data());
    double length = 1;
    std::size_t crossing = kMaxAtoms;
    for (std::size_t i = 0; i < n; ++i) {
        const double reach = -descent.code[active.atom[i]] / step[i];
        if (reach > 0 && reach < length) length = reach, crossing = i;
    }
    for (std::size_t i = 0; i < n; ++i) {
        float& coefficient = descent.code[active.atom[i]];
        coefficient = i == crossing ? 0.0F : coefficient + static_cast<float>(length * step[i]);
    }
    correlate(descent);
}

/// Exact steps on the non-zero atoms, each after a sweep over those that are not where they belong;
/// a code that was nearly right is so after the first step.
int descend(Descent& descent, float tolerance, int max_sweeps) {
    ActiveSet moving;
    jump_to_minimum(descent);
    int sweeps = 0;
    while (sweeps < max_sweeps) {
        moving.count = kernels::find_moves(descent.diagonal.data(), descent.inverse_diagonal.data(),
                                           descent.threshold, tolerance, descent.code,
                                           descent.residual.data(), descent.d, moving.atom.data());
        if (moving.count == 0) break;
        ++sweeps;
        (void)sweep(descent, moving);
        jump_to_minimum(descent);
    }
    return sweeps;
}

}  // namespace

int solve_coordinate_descent(const LassoProblem& problem, std::span<float> code, float tolerance,
                             int max_sweeps) {
    Descent descent;  // large, and set by start()
    descent.gram = problem.gram.data();
    descent.correlations = problem.correlations.data();
    descent.d = code.size();
    descent.threshold = problem.lambda / 2;
    descent.code = code.data();
    start(descent);
    return descend(descent, tolerance, max_sweeps);
}

void debias(const LassoProblem& problem, std::span<float> code) {
    const std::size_t d = code.size();
    std::array<std::size_t, kMaxAtoms> support;
    std::array<double, kMaxAtoms> values;
    PackedCholesky<kMaxAtoms> factor;
    for (std::size_t k = 0; k < d; ++k) {
        if (code[k] == 0) continue;
        const std::size_t n = factor.size();
        const float* row = problem.gram.data() + k * d;
        for (std::size_t i = 0; i < n; ++i) values[i] = row[support[i]];
        if (!factor.append(values.data(), row[k])) return;
        support[n] = k;
    }
    for (std::size_t i = 0; i < factor.size(); ++i) values[i] = problem.correlations[support[i]];
    factor.solve(values.data());
    for (std::size_t i = 0; i < factor.size(); ++i)
        code[support[i]] = static_cast<float>(values[i]);
}

double lasso_objective(const LassoProblem& problem, std::span<const float> code) {
    const std::size_t d = code.size();
    double objective = 0;
    for (std::size_t k = 0; k < d; ++k) {
        if (code[k] == 0) continue;
        double image = 0;
        for (std::size_t j = 0; j < d; ++j) image += double{problem.gram[k * d + j]} * code[j];
        objective += code[k] * (image - 2 * double{problem.correlations[k]});
        objective += double{problem.lambda} * std::abs(code[k]);
    }
    return objective;
}

}  // namespace lpf
