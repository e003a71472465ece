#include "core/learn/lasso.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "core/base/coding_kernels.h"
#include "core/base/kernels.h"
#include "core/learn/packed_cholesky.h"

namespace lpf {
namespace {

/// What the fields that are coded together share.
struct Atoms {
    explicit Atoms(std::span<const float> values, std::size_t count)
        : gram(values.data()), d(count) {
        for (std::size_t k = 0; k < d; ++k) {
            diagonal[k] = gram[k * d + k];
            inverse_diagonal[k] = diagonal[k] > 0 ? 1 / diagonal[k] : 0;
        }
    }
    const float* gram;
    std::size_t d;
    std::array<float, kMaxAtoms> diagonal;          // filled as far as it is used
    std::array<float, kMaxAtoms> inverse_diagonal;  // 0 for an atom of norm 0
};

/// Some of the atoms, in ascending order.
struct ActiveSet {
    std::array<unsigned, kMaxAtoms + 1> atom;
    std::size_t count = 0;
};

/// State of a descent: residual correlations r = c - G a are kept up to date, so that visiting an
/// atom costs O(1) unless its coefficient moves.
class Descent {
public:
    Descent() = default;  // leaves large arrays as they are

    void start(const Atoms& atoms, const LassoTask& task) {
        atoms_ = &atoms;
        correlations_ = task.correlations.data();
        threshold_ = task.lambda / 2;
        code_ = task.code.data();
        for (std::size_t k = 0; k < atoms.d; ++k) {
            if (!(atoms.diagonal[k] > 0)) code_[k] = 0;
        }
        correlate();
    }

    [[nodiscard]] std::size_t non_zeros() const { return active_.count; }

    /// Writes what a step to the minimum solves as number s of the systems of n unknowns.
    void write_system(std::size_t s, std::size_t n, double* systems) const {
        for (std::size_t i = 0; i < active_.count; ++i) {
            const unsigned k = active_.atom[i];
            const float* row = atoms_->gram + k * atoms_->d;
            double* const to = systems + kernels::row_of_system(i, n) * kernels::kSystems + s;
            for (std::size_t j = i; j < active_.count; ++j) {
                to[j * kernels::kSystems] = double{row[active_.atom[j]]};
            }
            to[n * kernels::kSystems] = double{residual_[k] - std::copysign(threshold_, code_[k])};
        }
    }

    /// With the signs held, Eq. 3 is a quadratic: walks straight to its minimum, or to the first
    /// coefficient that reaches zero on the way.
    /// @param steps of the non-zero coefficients, those of several systems side by side
    void walk(const double* steps) {
        double length = 1;
        std::size_t crossing = kMaxAtoms;
        for (std::size_t i = 0; i < active_.count; ++i) {
            const double reach = -code_[active_.atom[i]] / steps[i * kernels::kSystems];
            if (reach > 0 && reach < length) length = reach, crossing = i;
        }
        for (std::size_t i = 0; i < active_.count; ++i) {
            float& coefficient = code_[active_.atom[i]];
            const auto move = static_cast<float>(length * steps[i * kernels::kSystems]);
            coefficient = i == crossing ? 0.0F : coefficient + move;
        }
        correlate();
    }

    /// Moves the coefficients that one by one would move by more than the tolerance.
    /// @returns whether there were any
    bool sweep(float tolerance) {
        active_.count = kernels::find_moves(
            atoms_->diagonal.data(), atoms_->inverse_diagonal.data(), threshold_, tolerance, code_,
            residual_.data(), atoms_->d, active_.atom.data());
        if (active_.count == 0) return false;
        kernels::descent_sweep(atoms_->gram, atoms_->d, threshold_, atoms_->inverse_diagonal.data(),
                               active_.atom.data(), active_.count, code_, residual_.data());
        find_non_zero();
        return true;
    }

private:
    void find_non_zero() {
        active_.count = 0;
        for (std::size_t k = 0; k < atoms_->d; ++k) {
            active_.atom[active_.count] = static_cast<unsigned>(k);
            active_.count += static_cast<std::size_t>(code_[k] != 0);
        }
    }

    /// The residual correlations of the code as it is.
    void correlate() {
        find_non_zero();
        std::array<float, kMaxAtoms> coefficient;
        for (std::size_t i = 0; i < active_.count; ++i) coefficient[i] = code_[active_.atom[i]];
        kernels::combine_rows(atoms_->gram, atoms_->d, atoms_->d, active_.atom.data(),
                              coefficient.data(), active_.count, residual_.data());
        for (std::size_t k = 0; k < atoms_->d; ++k) {
            residual_[k] = correlations_[k] - residual_[k];
        }
    }

    const Atoms* atoms_;
    const float* correlations_;
    float threshold_;  // lambda / 2, as Eq. 3 has no factor 1/2
    float* code_;
    std::array<float, kMaxAtoms> residual_;
    ActiveSet active_;
};

/// Values of all systems side by side, in one line of the cache.
struct alignas(64) Side {
    double value[kernels::kSystems];
};

/// Takes steps of fields that are coded at the same time.
class ExactSteps {
public:
    explicit ExactSteps(const Atoms& atoms)
        : room_(
              std::make_unique_for_overwrite<Side[]>(kernels::size_of_system(atoms.d) + atoms.d)) {}

    /// Where correlated atoms make the sweeps crawl: steps of all to the minimum for their signs.
    /// Atoms that depend linearly on those before them stay where they are.
    void jump_to_minima(std::span<Descent*> running) {
        std::size_t n = 0;
        for (const Descent* descent : running) n = std::max(n, descent->non_zeros());
        double* const systems = room_[0].value;
        double* const steps = room_[kernels::size_of_system(n)].value;
        std::fill(systems, steps, 0.0);
        for (std::size_t s = 0; s < running.size(); ++s) running[s]->write_system(s, n, systems);
        kernels::solve_definite(systems, n, steps);
        for (std::size_t s = 0; s < running.size(); ++s) running[s]->walk(steps + s);
    }

private:
    std::unique_ptr<Side[]> room_;
};

/// Exact steps on the non-zero coefficients, and after each a sweep over those that still move: a
/// code that was nearly right is so after the first step.
/// @returns the most sweeps that any took
int descend(const Atoms& atoms, std::span<const LassoTask> tasks, float tolerance, int max_sweeps) {
    std::array<Descent, kernels::kSystems> descents;
    std::array<Descent*, kernels::kSystems> running;
    for (std::size_t s = 0; s < tasks.size(); ++s) {
        descents[s].start(atoms, tasks[s]);
        running[s] = &descents[s];
    }
    ExactSteps exact_steps(atoms);
    std::size_t count = tasks.size();
    for (int sweeps = 0;; ++sweeps) {
        exact_steps.jump_to_minima(std::span(running).first(count));
        if (sweeps == max_sweeps) return sweeps;
        const auto end = std::remove_if(running.begin(), running.begin() + count,
                                        [&](Descent* one) { return !one->sweep(tolerance); });
        count = static_cast<std::size_t>(end - running.begin());
        if (count == 0) return sweeps;
    }
}

}  // namespace

int solve_coordinate_descent(std::span<const float> gram, std::span<const LassoTask> tasks,
                             float tolerance, int max_sweeps) {
    if (tasks.empty()) return 0;
    const Atoms atoms(gram, tasks.front().code.size());
    int most = 0;
    while (!tasks.empty()) {
        const std::size_t count = std::min(tasks.size(), kernels::kSystems);
        most = std::max(most, descend(atoms, tasks.first(count), tolerance, max_sweeps));
        tasks = tasks.subspan(count);
    }
    return most;
}

int solve_coordinate_descent(const LassoProblem& problem, std::span<float> code, float tolerance,
                             int max_sweeps) {
    const LassoTask task{problem.correlations, problem.lambda, code};
    return solve_coordinate_descent(problem.gram, {&task, 1}, tolerance, max_sweeps);
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
