#include "tests/bench/stages/peak.h"

#include <algorithm>
#include <chrono>

#include "core/base/multiversion.h"

namespace lpf::bench {

namespace {

template <int kWidth>
LPF_INLINE float multiply_and_add_in(std::size_t rounds, float factor, float summand) {
    // Twelve independent sums: as many as two units with a latency of six keep busy.
    using Floats = typename kernels::Registers<kWidth>::Floats;
    const Floats one = 1.0F - Floats{};  // all start elsewhere, so that none is left out as equal
    Floats s0 = 0 * one, s1 = 1 * one, s2 = 2 * one, s3 = 3 * one, s4 = 4 * one, s5 = 5 * one;
    Floats s6 = 6 * one, s7 = 7 * one, s8 = 8 * one, s9 = 9 * one, s10 = 10 * one, s11 = 11 * one;
    const Floats by = factor - Floats{};
    for (std::size_t i = 0; i < rounds * (16 / kWidth); ++i) {
        s0 = s0 * by + summand, s1 = s1 * by + summand, s2 = s2 * by + summand;
        s3 = s3 * by + summand, s4 = s4 * by + summand, s5 = s5 * by + summand;
        s6 = s6 * by + summand, s7 = s7 * by + summand, s8 = s8 * by + summand;
        s9 = s9 * by + summand, s10 = s10 * by + summand, s11 = s11 * by + summand;
    }
    const Floats sum = s0 + s1 + s2 + s3 + s4 + s5 + s6 + s7 + s8 + s9 + s10 + s11;
    float largest = sum[0];
    for (int k = 1; k < kWidth; ++k) largest = sum[k] > largest ? sum[k] : largest;
    return largest;
}

}  // namespace

LPF_WITH_REGISTERS(float, multiply_and_add, (std::size_t rounds, float factor, float summand),
                   (rounds, factor, summand))

double peak_rate() {
    static const double kRate = [] {
        constexpr std::size_t kRounds = 1U << 20U;
        double best = 0;
        float kept = 0;
        for (int i = 0; i < 20; ++i) {
            const auto start = std::chrono::steady_clock::now();
            kept += multiply_and_add(kRounds, 0.5F, 1.0F);
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
            best = std::max(best, kRounds * kOperationsOfRound / took.count());
        }
        return kept > 0 ? best : 0.0;
    }();
    return kRate;
}

}  // namespace lpf::bench
