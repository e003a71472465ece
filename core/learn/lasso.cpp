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
    std::size_t d;
    float threshold;  // lambda / 2, as Eq. 3 has no factor 1/2
    float* code;
    std::array<float, kMaxAtoms> residual;
    std::array<float, kMaxAtoms> inverse_diagonal;  // 0 for an atom of norm 0
};

void start(Descent& descent, const LassoProblem& problem) {
    for (std::size_t k = 0; k < descent.d; ++k) {
        const float diagonal = descent.gram[k * descent.d + k];
        descent.inverse_diagonal[k] = diagonal > 0 ? 1 / diagonal : 0;
        descent.residual[k] = problem.correlations[k];
        if (!(diagonal > 0)) descent.code[k] = 0;
    }
    for (std::size_t k = 0; k < descent.d; ++k) {
        if (descent.code[k] == 0) continue;
        kernels::add_scaled(-descent.code[k], descent.gram + k * descent.d, descent.residual.data(),
                            descent.d);
    }
}

/// Minimises over one coefficient. @returns how far it moved
inline float visit(Descent& descent, std::size_t k) {
    const float old = descent.code[k];
    const float* row = descent.gram + k * descent.d;
    const float pull = descent.residual[k] + row[k] * old;
    const float excess = std::abs(pull) - descent.threshold;
    const float magnitude = excess > 0 ? excess * descent.inverse_diagonal[k] : 0;
    const float move = std::copysign(magnitude, pull) - old;
    if (move == 0) return 0;
    descent.code[k] = old + move;
    kernels::add_scaled(-move, row, descent.residual.data(), descent.d);
    return std::abs(move);
}

/// Non-zero atoms, in ascending order.
struct ActiveSet {
    std::array<std::size_t, kMaxAtoms> atom;
    std::size_t count = 0;
};

/// One sweep over all atoms. @returns the largest move; `active` receives the non-zero atoms
float sweep_all(Descent& descent, ActiveSet& active) {
    float largest = 0;
    active.count = 0;
    for (std::size_t k = 0; k < descent.d; ++k) {
        largest = std::max(largest, visit(descent, k));
        if (descent.code[k] != 0) active.atom[active.count++] = k;
    }
    return largest;
}

float sweep_active(Descent& descent, const ActiveSet& active) {
    float largest = 0;
    for (std::size_t i = 0; i < active.count; ++i) {
        largest = std::max(largest, visit(descent, active.atom[i]));
    }
    return largest;
}

/// Where correlated atoms make the sweeps crawl: with the signs held, Eq. 3 is a quadratic, so walk
/// straight to its minimum, or to the first coefficient that reaches zero on the way.
void jump_to_minimum(Descent& descent, const ActiveSet& active) {
    PackedCholesky<kMaxAtoms> factor;
    std::array<double, kMaxAtoms> step;
    ActiveSet free;  // those that do not depend linearly on the ones before
    for (std::size_t i = 0; i < active.count; ++i) {
        const std::size_t k = active.atom[i];
        if (descent.code[k] == 0) continue;
        const float* row = descent.gram + k * descent.d;
        for (std::size_t j = 0; j < free.count; ++j) step[j] = row[free.atom[j]];
        if (factor.append(step.data(), row[k])) free.atom[free.count++] = k;
    }
    for (std::size_t i = 0; i < free.count; ++i) {
        const std::size_t k = free.atom[i];
        step[i] = descent.residual[k] - std::copysign(descent.threshold, descent.code[k]);
    }
    factor.solve(step.data());
    double length = 1;
    std::size_t crossing = kMaxAtoms;
    for (std::size_t i = 0; i < free.count; ++i) {
        const double reach = -descent.code[free.atom[i]] / step[i];
        if (reach > 0 && reach < length) length = reach, crossing = i;
    }
    for (std::size_t i = 0; i < free.count; ++i) {
        const std::size_t k = free.atom[i];
        const float old = descent.code[k];
        descent.code[k] = i == crossing ? 0 : old + static_cast<float>(length * step[i]);
        kernels::add_scaled(old - descent.code[k], descent.gram + k * descent.d,
                            descent.residual.data(), descent.d);
    }
}

/// Sweeps over all atoms, each followed by a few over the non-zero ones.
int descend(Descent& descent, float tolerance, int max_sweeps) {
    constexpr int kActiveSweeps = 4;
    ActiveSet active;
    int sweeps = 0;
    while (sweeps < max_sweeps) {
        ++sweeps;
        float largest = sweep_all(descent, active);
        if (largest <= tolerance) break;
        for (int i = 0; i < kActiveSweeps && largest > tolerance && sweeps < max_sweeps; ++i) {
            ++sweeps;
            largest = sweep_active(descent, active);
        }
        if (largest > tolerance) jump_to_minimum(descent, active);
    }
    return sweeps;
}

}  // namespace

int solve_coordinate_descent(const LassoProblem& problem, std::span<float> code, float tolerance,
                             int max_sweeps) {
    Descent descent;  // large, and set by start()
    descent.gram = problem.gram.data();
    descent.d = code.size();
    descent.threshold = problem.lambda / 2;
    descent.code = code.data();
    start(descent, problem);
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
