#include "core/learn/lasso.h"

#include <algorithm>
#include <array>
#include <bit>
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

/// Values of all systems side by side, in one line of the cache.
struct alignas(64) Side {
    double value[kernels::kSystems];
};

/// What the steps of several descents to their minima solve for; a place that no atom is set at
/// counts as none.
class Systems {
public:
    explicit Systems(std::size_t atoms)
        : room_(std::make_unique_for_overwrite<Side[]>(kernels::size_of_system(atoms) + 3 * atoms)),
          numbers_(std::make_unique_for_overwrite<unsigned[]>(atoms * kernels::kSystems)) {}

    /// Empties them. @param n atoms of each, at most
    void reset(std::size_t n) {
        n_ = n;
        std::fill_n(used(), 2 * n * kernels::kSystems, 0.0);  // and the right-hand sides behind
        std::fill_n(numbers_.get(), n * kernels::kSystems, 0U);
    }

    void set(std::size_t s, std::size_t i, unsigned atom, double right_hand_side) {
        const std::size_t at = i * kernels::kSystems + s;
        numbers_[at] = atom;
        used()[at] = 1.0;
        right()[at] = right_hand_side;
    }

    /// @returns the unknowns: number i of system s at i kSystems + s
    const double* solve(const float* gram, std::size_t d) {
        double* const entries = room_[3 * n_].value;
        kernels::write_systems(gram, d, n_, numbers_.get(), used(), right(), entries);
        kernels::solve_definite(entries, n_, room_[2 * n_].value);
        return room_[2 * n_].value;
    }

private:
    [[nodiscard]] double* used() { return room_[0].value; }
    [[nodiscard]] double* right() { return room_[n_].value; }

    std::size_t n_ = 0;
    std::unique_ptr<Side[]> room_;  // what is used, right-hand sides, unknowns, the systems
    std::unique_ptr<unsigned[]> numbers_;
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

    /// Writes what a step to the minimum solves for, as number s of the systems.
    void write_system(std::size_t s, Systems& systems) const {
        for (std::size_t i = 0; i < active_.count; ++i) {
            const unsigned k = active_.atom[i];
            const float side = std::copysign(threshold_, code_[k]);
            systems.set(s, i, k, double{residual_[k] - side});
        }
    }

    /// With the signs held, Eq. 3 is a quadratic: walks straight to its minimum, or to the first
    /// coefficient that reaches zero on the way.
    /// @param steps of the non-zero coefficients, those of several systems side by side
    void walk(const double* steps) {
        double length = 1;
        std::size_t crossing = kMaxAtoms;
        for (std::size_t i = 0; i < active_.count; ++i) {
            const double step = steps[i * kernels::kSystems];
            const double from = code_[active_.atom[i]];
            // Few cross: no division for the others, and no branch on a sign.
            const bool shrinks = from * step < 0;
            const bool is_short = std::abs(from) < length * std::abs(step);
            if (static_cast<int>(shrinks) & static_cast<int>(is_short)) {
                length = -from / step, crossing = i;
            }
        }
        for (std::size_t i = 0; i < active_.count; ++i) {
            float& coefficient = code_[active_.atom[i]];
            const auto move = static_cast<float>(length * steps[i * kernels::kSystems]);
            coefficient = i == crossing ? 0.0F : coefficient + move;
        }
        correlate();
    }

    /// Lists the coefficients that one by one would move by more than the tolerance.
    /// @returns whether there are any
    bool find_moves(float tolerance) {
        active_.count = kernels::find_moves(
            atoms_->diagonal.data(), atoms_->inverse_diagonal.data(), threshold_, tolerance, code_,
            residual_.data(), atoms_->d, active_.atom.data());
        return active_.count > 0;
    }

    /// The sweep over these.
    [[nodiscard]] kernels::Sweep sweep() {
        return {threshold_, active_.atom.data(), active_.count, code_, residual_.data()};
    }

    /// Lists the non-zero coefficients instead.
    void find_non_zero() {
        active_.count = 0;
        for (std::size_t k = 0; k < atoms_->d; ++k) {
            active_.atom[active_.count] = static_cast<unsigned>(k);
            // By its bits: a comparison of floats would ask for NaN as well.
            active_.count += static_cast<std::size_t>(std::bit_cast<unsigned>(code_[k]) << 1 != 0);
        }
    }

private:
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

/// Where correlated atoms make the sweeps crawl: steps of all to the minimum for their signs.
/// Atoms that depend linearly on those before them stay where they are.
void jump_to_minima(const Atoms& atoms, std::span<Descent*> running, Systems& systems) {
    std::size_t n = 0;
    for (const Descent* descent : running) n = std::max(n, descent->non_zeros());
    systems.reset(n);
    for (std::size_t s = 0; s < running.size(); ++s) running[s]->write_system(s, systems);
    const double* const steps = systems.solve(atoms.gram, atoms.d);
    for (std::size_t s = 0; s < running.size(); ++s) running[s]->walk(steps + s);
}

/// A sweep of each over the coefficients that still move.
/// @returns those that had any, moved to the front
std::span<Descent*> sweep(const Atoms& atoms, std::span<Descent*> running, float tolerance) {
    const auto end = std::remove_if(running.begin(), running.end(),
                                    [&](Descent* one) { return !one->find_moves(tolerance); });
    running = running.first(static_cast<std::size_t>(end - running.begin()));
    std::array<kernels::Sweep, kernels::kSystems> sweeps;
    for (std::size_t s = 0; s < running.size(); ++s) sweeps[s] = running[s]->sweep();
    kernels::descent_sweeps(atoms.gram, atoms.d, atoms.inverse_diagonal.data(), sweeps.data(),
                            running.size());
    for (Descent* one : running) one->find_non_zero();
    return running;
}

/// A few sweeps, in which most atoms leave or join that are to, take turns with exact steps on the
/// non-zero coefficients: a code that was nearly right is so after the first.
/// @returns the most sweeps that any took
int descend(const Atoms& atoms, std::span<const LassoTask> tasks, float tolerance, int max_sweeps) {
    constexpr int kSweepsBeforeStep = 2;
    std::array<Descent, kernels::kSystems> descents;
    std::array<Descent*, kernels::kSystems> all;
    for (std::size_t s = 0; s < tasks.size(); ++s) {
        descents[s].start(atoms, tasks[s]);
        all[s] = &descents[s];
    }
    Systems systems(atoms.d);
    std::span<Descent*> running = std::span(all).first(tasks.size());
    for (int sweeps = 0; sweeps < max_sweeps;) {
        for (int i = 0; i < kSweepsBeforeStep && sweeps < max_sweeps; ++i, ++sweeps) {
            running = sweep(atoms, running, tolerance);
            if (running.empty()) return sweeps;
        }
        jump_to_minima(atoms, running, systems);
    }
    return max_sweeps;
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
