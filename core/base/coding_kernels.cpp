// The loops that the codes of fields come from.
#include "core/base/coding_kernels.h"

#include <cmath>

#include "core/base/multiversion.h"

namespace lpf::kernels {

namespace {

/// Those of the systems that lie in one register: entry i of each.
template <int kWidth>
struct SystemsOfRegister {
    using Doubles = typename Registers<kWidth>::DoublesAt;
    static constexpr std::size_t kCount = kWidth / 2;

    double* values;

    LPF_INLINE Doubles& operator[](std::size_t i) const {
        return doubles_at<kWidth>(values + i * kSystems);
    }
    LPF_INLINE SystemsOfRegister from(std::size_t i) const { return {values + i * kSystems}; }
};

template <int kWidth>
LPF_INLINE void write_systems_in(const float* gram, std::size_t d, std::size_t n,
                                 const unsigned* atoms, const double* used, const double* right,
                                 double* systems) {
    using Doubles = typename Registers<kWidth>::DoublesAt;
    constexpr std::size_t kCount = SystemsOfRegister<kWidth>::kCount;
    for (std::size_t first = 0; first < kSystems; first += kCount) {
        const SystemsOfRegister<kWidth> to{systems + first};
        for (std::size_t i = 0; i < n; ++i) {
            const float* row[kCount];
            for (std::size_t s = 0; s < kCount; ++s) {
                row[s] = gram + atoms[i * kSystems + first + s] * d;
            }
            const std::size_t begin = row_of_system(i, n);
            const Doubles row_used = doubles_at<kWidth>(used + i * kSystems + first);
            for (std::size_t j = i; j < n; ++j) {
                const unsigned* const k = atoms + j * kSystems + first;
                const Doubles column_used = doubles_at<kWidth>(used + j * kSystems + first);
                Doubles entries;
                for (std::size_t s = 0; s < kCount; ++s) entries[s] = row[s][k[s]];
                to[begin + j] = entries * (row_used * column_used);
            }
            to[begin + n] = doubles_at<kWidth>(right + i * kSystems + first);
        }
    }
}

/// @param a, x those of one register
template <int kWidth>
LPF_INLINE void solve_some(SystemsOfRegister<kWidth> a, std::size_t n,
                           SystemsOfRegister<kWidth> x) {
    using Doubles = typename Registers<kWidth>::DoublesAt;
    constexpr double kDependent = 1e-6;  // share of its diagonal under which a pivot is rounding
    const auto row = [a, n](std::size_t i) { return a.from(row_of_system(i, n)); };
    const SystemsOfRegister<kWidth> inverse = x;  // of the pivots, until x is known
    for (std::size_t k = 0; k < n; ++k) inverse[k] = kDependent * row(k)[k];
    // Two pivots at a time: what lies below is loaded and stored once for both.
    for (std::size_t k = 0; k < n; k += 2) {
        const auto pivots = row(k);
        const auto next = row(k + 1);
        inverse[k] = pivots[k] > inverse[k] ? 1 / pivots[k] : Doubles{};
        if (k + 1 == n) break;
        const Doubles factor = pivots[k + 1] * inverse[k];
        for (std::size_t j = k + 1; j <= n; ++j) next[j] -= factor * pivots[j];
        inverse[k + 1] = next[k + 1] > inverse[k + 1] ? 1 / next[k + 1] : Doubles{};
        for (std::size_t i = k + 2; i < n; i += 2) {
            const auto above = row(i);
            const Doubles p0 = pivots[i] * inverse[k], q0 = next[i] * inverse[k + 1];
            above[i] = above[i] - p0 * pivots[i] - q0 * next[i];
            if (i + 1 == n) {
                above[n] = above[n] - p0 * pivots[n] - q0 * next[n];
                break;
            }
            const auto below = row(i + 1);
            const Doubles p1 = pivots[i + 1] * inverse[k], q1 = next[i + 1] * inverse[k + 1];
            for (std::size_t j = i + 1; j <= n; ++j) {
                const Doubles p = pivots[j], q = next[j];
                above[j] = above[j] - p0 * p - q0 * q;
                below[j] = below[j] - p1 * p - q1 * q;
            }
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        const Doubles known = inverse[k] * row(k)[n];
        inverse[k] = known;
        for (std::size_t i = 0; i < k; ++i) row(i)[n] -= row(i)[k] * known;
    }
}

template <int kWidth>
LPF_INLINE void solve_definite_in(double* a, std::size_t n, double* x) {
    for (std::size_t s = 0; s < kSystems; s += SystemsOfRegister<kWidth>::kCount) {
        solve_some<kWidth>({a + s}, n, {x + s});
    }
}

}  // namespace

LPF_WITH_REGISTERS(void, write_systems,
                   (const float* gram, std::size_t d, std::size_t n, const unsigned* atoms,
                    const double* used, const double* right, double* systems),
                   (gram, d, n, atoms, used, right, systems))

LPF_WITH_REGISTERS(void, solve_definite, (double* a, std::size_t n, double* x), (a, n, x))

LPF_MULTIVERSION
std::size_t find_moves(const float* diagonal, const float* inverse_diagonal, float threshold,
                       float tolerance, const float* code, const float* residual, std::size_t d,
                       unsigned* atoms) {
    std::size_t count = 0;
    for (std::size_t begin = 0; begin < d; begin += kLanes) {
        const std::size_t size = d - begin < kLanes ? d - begin : kLanes;
        float moves[kLanes];
#pragma omp simd
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t k = begin + i;
            const float pull = residual[k] + diagonal[k] * code[k];
            const float excess = std::abs(pull) - threshold;
            const float magnitude = (excess > 0 ? excess : 0) * inverse_diagonal[k];
            moves[i] = std::abs(std::copysign(magnitude, pull) - code[k]);
        }
        // Written always and counted if it moves: no branch to be foretold.
        for (std::size_t i = 0; i < size; ++i) {
            atoms[count] = static_cast<unsigned>(begin + i);
            count += static_cast<std::size_t>(moves[i] > tolerance);
        }
    }
    return count;
}

LPF_MULTIVERSION
void descent_sweeps(const float* gram, std::size_t d, const float* inverse_diagonal,
                    const Sweep* sweeps, std::size_t n) {
    std::size_t most = 0;
    for (std::size_t s = 0; s < n; ++s) most = sweeps[s].count > most ? sweeps[s].count : most;
    for (std::size_t i = 0; i < most; ++i) {
        for (std::size_t s = 0; s < n; ++s) {
            const Sweep& sweep = sweeps[s];
            if (i >= sweep.count) continue;
            const std::size_t k = sweep.atoms[i];
            const float* const row = gram + k * d;
            float* const residual = sweep.residual;
            const float old = sweep.code[k];
            const float pull = residual[k] + row[k] * old;
            const float excess = std::abs(pull) - sweep.threshold;
            const float magnitude = excess > 0 ? excess * inverse_diagonal[k] : 0;
            const float move = std::copysign(magnitude, pull) - old;
            sweep.code[k] = old + move;
#pragma omp simd
            for (std::size_t j = 0; j < d; ++j) residual[j] -= move * row[j];
        }
    }
}

}  // namespace lpf::kernels
