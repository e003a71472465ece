#include <algorithm>
#include <array>
#include <cmath>

#include "core/learn/lasso.h"
#include "core/learn/packed_cholesky.h"

namespace lpf {
namespace {

constexpr double kTiny = 1e-10;

/// The LASSO path from lambda = infinity down. On it every active atom has the same absolute
/// correlation C with the residual, no other atom has more, and C = lambda / 2 (Eq. 3 has no 1/2).
class LarsPath {
public:
    LarsPath(const LassoProblem& problem, std::size_t d) : problem_(problem), d_(d) {
        for (std::size_t k = 0; k < d; ++k) {
            code_[k] = 0;
            residual_[k] = problem.correlations[k];
            state_[k] = gram(k, k) > 0 ? State::Idle : State::Never;
            if (state_[k] == State::Idle) level_ = std::max(level_, std::abs(residual_[k]));
        }
    }

    void follow_to(double target) {
        const double end = std::max(target, kTiny * level_);
        // Every event but the last adds or drops an atom; the bound is far above what paths need.
        for (std::size_t events = 0; level_ > end && events < 16 * d_ + 16; ++events) {
            join_all_at_level();
            if (factor_.size() == 0) return;
            find_direction();
            const Event event = next_event(level_ - end);
            advance(event.length);
            if (event.drop) drop(event.atom);
        }
    }

    [[nodiscard]] double code(std::size_t k) const { return code_[k]; }

private:
    enum class State { Idle, Active, Dependent, Dropped, Never };
    struct Event {
        double length;         // by how much C falls until then
        std::size_t atom = 0;  // position among the active atoms
        bool drop = false;
    };

    [[nodiscard]] double gram(std::size_t i, std::size_t j) const {
        return problem_.gram[i * d_ + j];
    }

    /// Activates every idle atom whose correlation has reached C.
    void join_all_at_level() {
        for (std::size_t k = 0; k < d_; ++k) {
            if (state_[k] == State::Dropped) {
                state_[k] = State::Idle;  // it must first move off the level
                continue;
            }
            if (state_[k] != State::Idle) continue;
            if (std::abs(residual_[k]) < level_ * (1 - kTiny)) continue;
            std::array<double, kMaxAtoms> column;
            const std::size_t n = factor_.size();
            for (std::size_t i = 0; i < n; ++i) column[i] = gram(active_[i], k);
            if (factor_.append(column.data(), gram(k, k))) {
                state_[k] = State::Active;
                active_[n] = k;
                sign_[n] = residual_[k] > 0 ? 1 : -1;
            } else {
                state_[k] = State::Dependent;
            }
        }
    }

    /// As C falls by t, the code moves by t * step_ and the residual correlations by -t * fall_.
    void find_direction() {
        const std::size_t n = factor_.size();
        std::copy_n(sign_.data(), n, step_.data());
        factor_.solve(step_.data());
        for (std::size_t k = 0; k < d_; ++k) {
            fall_[k] = 0;
            for (std::size_t i = 0; i < n; ++i) fall_[k] += gram(active_[i], k) * step_[i];
        }
    }

    [[nodiscard]] Event next_event(double remaining) const {
        Event event{remaining};
        for (std::size_t k = 0; k < d_; ++k) {
            if (state_[k] != State::Idle) continue;
            for (const double side : {1.0, -1.0}) {
                const double closing = 1 - side * fall_[k];
                if (closing <= kTiny) continue;
                const double length = std::max(0.0, (level_ - side * residual_[k]) / closing);
                if (length < event.length) event = {length};
            }
        }
        for (std::size_t i = 0; i < factor_.size(); ++i) {
            const double length = -code_[active_[i]] / step_[i];
            if (length > 0 && length < event.length) event = {length, i, true};
        }
        return event;
    }

    void advance(double length) {
        for (std::size_t i = 0; i < factor_.size(); ++i) code_[active_[i]] += length * step_[i];
        for (std::size_t k = 0; k < d_; ++k) residual_[k] -= length * fall_[k];
        level_ -= length;
    }

    void drop(std::size_t position) {
        const std::size_t atom = active_[position];
        factor_.remove(position);
        std::copy(active_.begin() + position + 1, active_.begin() + factor_.size() + 1,
                  active_.begin() + position);
        std::copy(sign_.begin() + position + 1, sign_.begin() + factor_.size() + 1,
                  sign_.begin() + position);
        code_[atom] = 0;
        // What depended on the dropped atom may be independent of those left.
        for (std::size_t k = 0; k < d_; ++k) {
            if (state_[k] == State::Dependent) state_[k] = State::Dropped;
        }
        state_[atom] = State::Dropped;
    }

    const LassoProblem& problem_;
    std::size_t d_;
    double level_ = 0;  // C
    PackedCholesky<kMaxAtoms> factor_;
    std::array<std::size_t, kMaxAtoms> active_;  // in the order of the factor's rows
    std::array<double, kMaxAtoms> sign_;         // of the active atoms' correlations
    std::array<double, kMaxAtoms> step_;
    std::array<double, kMaxAtoms> fall_;
    std::array<double, kMaxAtoms> code_;
    std::array<double, kMaxAtoms> residual_;
    std::array<State, kMaxAtoms> state_;
};

}  // namespace

void solve_lars(const LassoProblem& problem, std::span<float> code) {
    LarsPath path(problem, code.size());
    path.follow_to(double{problem.lambda} / 2);
    for (std::size_t k = 0; k < code.size(); ++k) code[k] = static_cast<float>(path.code(k));
}

}  // namespace lpf
