#include "core/base/coding_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

using kernels::kSystems;

/// A symmetric system of which one unknown, if any, depends on unknown 0.
struct System {
    std::size_t n;
    std::size_t dependent;  // a copy of unknown 0; n for none
    std::vector<double> rows;

    System(std::size_t size, std::size_t copy, std::uint64_t seed)
        : n(size), dependent(copy), rows(size * kColumns) {
        Random random(seed);
        for (double& value : rows) value = random.normal();
    }
    [[nodiscard]] double matrix(std::size_t i, std::size_t j) const {
        double sum = 0;
        for (std::size_t k = 0; k < kColumns; ++k) {
            sum += rows[source(i) * kColumns + k] * rows[source(j) * kColumns + k];
        }
        return sum;
    }
    [[nodiscard]] double right(std::size_t i) const { return 1.0 + static_cast<double>(source(i)); }

    /// As number s of systems of `size` unknowns.
    void write(std::size_t s, std::size_t size, std::vector<double>& a) const {
        const auto at = [&](std::size_t i, std::size_t j) -> double& {
            return a[(kernels::row_of_system(i, size) + j) * kSystems + s];
        };
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = i; j < n; ++j) at(i, j) = matrix(i, j);
            at(i, size) = right(i);
        }
    }

private:
    static constexpr std::size_t kColumns = 40;
    [[nodiscard]] std::size_t source(std::size_t i) const { return i == dependent ? 0 : i; }
};

std::vector<double> solve(const std::vector<System>& systems, std::size_t size) {
    std::vector<double> a(kernels::size_of_system(size) * kSystems, 0.0);
    std::vector<double> x(size * kSystems, 99.0);
    for (std::size_t s = 0; s < systems.size(); ++s) systems[s].write(s, size, a);
    kernels::solve_definite(a.data(), size, x.data());
    return x;
}

TEST(CodingKernels, SolveDefiniteSolvesAllSystemsAndLeavesOutWhatDepends) {
    for (const std::size_t n : {1U, 2U, 3U, 7U, 8U, 22U, 35U}) {
        std::vector<System> systems;
        for (std::size_t s = 0; s < kSystems; ++s) {
            const std::size_t own = std::max<std::size_t>(1, n - s % 3 * n / 4);
            systems.emplace_back(own, s % 2 == 0 && own > 2 ? own / 2 : own, s);
        }
        const std::vector<double> x = solve(systems, n);
        for (std::size_t s = 0; s < kSystems; ++s) {
            const System& system = systems[s];
            const auto value = [&](std::size_t i) { return x[i * kSystems + s]; };
            EXPECT_TRUE(system.dependent == system.n || value(system.dependent) == 0.0);
            for (std::size_t i = 0; i < system.n; ++i) {
                double image = 0;
                for (std::size_t j = 0; j < system.n; ++j) image += system.matrix(i, j) * value(j);
                EXPECT_NEAR(image, system.right(i), 1e-6);
            }
            for (std::size_t i = system.n; i < n; ++i) EXPECT_EQ(value(i), 0.0);
        }
    }
}

TEST(CodingKernels, SystemsDoNotDependOnThoseBesideThem) {
    const System system(9, 4, 1);
    const std::vector<double> alone = solve({system}, 9);
    std::vector<System> systems(5, System(14, 14, 2));
    systems.push_back(system);
    const std::vector<double> together = solve(systems, 14);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(together[i * kSystems + 5], alone[i * kSystems]);
    }
}

/// Coefficients of a descent that has not ended.
struct Code {
    std::vector<float> gram, diagonal, inverse_diagonal, code, residual;

    explicit Code(std::size_t d) {
        Random random(d);
        const auto next = [&] { return static_cast<float>(random.normal()); };
        for (std::size_t k = 0; k < d; ++k) {
            diagonal.push_back(k == 3 ? 0.0F : 0.5F + std::abs(next()));
            inverse_diagonal.push_back(k == 3 ? 0.0F : 1 / diagonal[k]);
            code.push_back(k % 3 == 0 ? 0.0F : next());
            residual.push_back(next());
        }
        gram.resize(d * d);
        for (float& value : gram) value = 0.1F * next();
        for (std::size_t k = 0; k < d; ++k) gram[k * d + k] = diagonal[k];
    }

    /// By how much coordinate descent moves a coefficient.
    [[nodiscard]] float move(std::size_t k, float threshold) const {
        const float pull = residual[k] + diagonal[k] * code[k];
        const float shrunk = std::max(std::abs(pull) - threshold, 0.0F) * inverse_diagonal[k];
        return std::copysign(shrunk, pull) - code[k];
    }
};

constexpr std::size_t kSizes[] = {1, 5, 15, 16, 17, 32, 40, 64};
constexpr float kThreshold = 0.3F;

TEST(CodingKernels, FindMovesNamesWhatWouldMove) {
    for (const std::size_t d : kSizes) {
        const Code code(d);
        for (const float tolerance : {0.0F, 0.5F, 100.0F}) {
            std::vector<unsigned> expected;
            for (unsigned k = 0; k < d; ++k) {
                if (std::abs(code.move(k, kThreshold)) > tolerance) expected.push_back(k);
            }
            std::vector<unsigned> found(d + 1);
            found.resize(kernels::find_moves(code.diagonal.data(), code.inverse_diagonal.data(),
                                             kThreshold, tolerance, code.code.data(),
                                             code.residual.data(), d, found.data()));
            EXPECT_EQ(found, expected) << d << " atoms, tolerance " << tolerance;
        }
    }
}

TEST(CodingKernels, SweepsMoveOneCoefficientOfEachCodeAfterTheOther) {
    for (const std::size_t d : kSizes) {
        std::vector<Code> expected(3, Code(d));
        std::vector<Code> codes(3, Code(d));
        std::vector<std::vector<unsigned>> atoms(3);  // all, every second, none
        for (unsigned k = 0; k < d; ++k) atoms[0].push_back(k);
        for (unsigned k = 0; k < d; k += 2) atoms[1].push_back(k);
        std::vector<kernels::Sweep> sweeps;
        for (std::size_t s = 0; s < 3; ++s) {
            for (const unsigned k : atoms[s]) {
                const float move = expected[s].move(k, kThreshold);
                expected[s].code[k] += move;
                for (std::size_t j = 0; j < d; ++j) {
                    expected[s].residual[j] -= move * expected[s].gram[k * d + j];
                }
            }
            sweeps.push_back({kThreshold, atoms[s].data(), atoms[s].size(), codes[s].code.data(),
                              codes[s].residual.data()});
        }
        kernels::descent_sweeps(codes[0].gram.data(), d, codes[0].inverse_diagonal.data(),
                                sweeps.data(), sweeps.size());
        for (std::size_t s = 0; s < 3; ++s) {
            for (std::size_t k = 0; k < d; ++k) {
                EXPECT_NEAR(codes[s].code[k], expected[s].code[k], 1e-5);
                EXPECT_NEAR(codes[s].residual[k], expected[s].residual[k], 1e-5);
            }
        }
    }
}

TEST(CodingKernels, WriteSystemsTakesTheEntriesOfTheAtomsInUse) {
    constexpr std::size_t kAtoms = 9;
    const Code code(kAtoms);
    for (const std::size_t n : {1U, 2U, 5U}) {
        std::vector<unsigned> atoms(n * kernels::kSystems);
        std::vector<double> used(atoms.size());
        std::vector<double> right(atoms.size());
        for (std::size_t i = 0; i < atoms.size(); ++i) {
            atoms[i] = static_cast<unsigned>(i * 7 % kAtoms);
            used[i] = i % 3 == 0 ? 0.0 : 1.0;
            right[i] = static_cast<double>(i);
        }
        std::vector<double> systems(kernels::size_of_system(n) * kernels::kSystems, -77.0);
        kernels::write_systems(code.gram.data(), kAtoms, n, atoms.data(), used.data(), right.data(),
                               systems.data());
        for (std::size_t s = 0; s < kernels::kSystems; ++s) {
            const auto at = [s](std::size_t i) { return i * kernels::kSystems + s; };
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t row = kernels::row_of_system(i, n);
                for (std::size_t j = i; j < n; ++j) {
                    const double entry = code.gram[atoms[at(i)] * kAtoms + atoms[at(j)]];
                    EXPECT_EQ(systems[at(row + j)], entry * used[at(i)] * used[at(j)]);
                }
                EXPECT_EQ(systems[at(row + n)], right[at(i)]);
            }
        }
    }
}

}  // namespace
}  // namespace lpf
