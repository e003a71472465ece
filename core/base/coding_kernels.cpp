// The loops that the codes of fields come from.
#include "core/base/coding_kernels.h"

#include <cmath>

#include "core/base/multiversion.h"

namespace lpf::kernels {

LPF_MULTIVERSION
void write_systems(const float* gram, std::size_t d, std::size_t n, const unsigned* atoms,
                   const double* used, const double* right, double* systems) {
    const auto at = [](const double* values, std::size_t i) -> const Doubles& {
        return reinterpret_cast<const Doubles*>(values)[i];
    };
    for (std::size_t i = 0; i < n; ++i) {
        const float* row[kSystems];
        for (std::size_t s = 0; s < kSystems; ++s) row[s] = gram + atoms[i * kSystems + s] * d;
        Doubles* const to = reinterpret_cast<Doubles*>(systems) + row_of_system(i, n);
        for (std::size_t j = i; j < n; ++j) {
            const unsigned* const k = atoms + j * kSystems;
            const Doubles entries = {row[0][k[0]], row[1][k[1]], row[2][k[2]], row[3][k[3]],
                                     row[4][k[4]], row[5][k[5]], row[6][k[6]], row[7][k[7]]};
            to[j] = entries * (at(used, i) * at(used, j));
        }
        to[n] = at(right, i);
    }
}

LPF_MULTIVERSION
void solve_definite(double* a, std::size_t n, double* x) {
    static_assert(kSystems == kDoubleLanes);
    constexpr double kDependent = 1e-6;  // share of its diagonal under which a pivot is rounding
    // Its type is written out: a deduced one would be that of aligned vectors.
    const auto row = [a, n](std::size_t i) -> Doubles* {
        return reinterpret_cast<Doubles*>(a) + row_of_system(i, n);
    };
    Doubles* const inverse = reinterpret_cast<Doubles*>(x);  // of the pivots, until x is known
    for (std::size_t k = 0; k < n; ++k) inverse[k] = kDependent * row(k)[k];
    // Two pivots at a time: what lies below is loaded and stored once for both.
    for (std::size_t k = 0; k < n; k += 2) {
        const Doubles* const pivots = row(k);
        Doubles* const next = row(k + 1);
        inverse[k] = pivots[k] > inverse[k] ? 1 / pivots[k] : Doubles{};
        if (k + 1 == n) break;
        const Doubles factor = pivots[k + 1] * inverse[k];
        for (std::size_t j = k + 1; j <= n; ++j) next[j] -= factor * pivots[j];
        inverse[k + 1] = next[k + 1] > inverse[k + 1] ? 1 / next[k + 1] : Doubles{};
        for (std::size_t i = k + 2; i < n; i += 2) {
            Doubles* const above = row(i);
            const Doubles p0 = pivots[i] * inverse[k], q0 = next[i] * inverse[k + 1];
            above[i] = above[i] - p0 * pivots[i] - q0 * next[i];
            if (i + 1 == n) {
                above[n] = above[n] - p0 * pivots[n] - q0 * next[n];
                break;
            }
            Doubles* const below = row(i + 1);
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
