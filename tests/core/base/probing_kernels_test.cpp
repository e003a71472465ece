#include "core/base/probing_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

using Floats = std::vector<float>;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

Floats random_floats(std::size_t n, std::uint64_t seed) {
    Random random(seed);
    Floats values(n);
    for (float& value : values) value = static_cast<float>(random.normal());
    return values;
}

/// Sizes below, at and above whole vectors.
class ProbingKernelsOf : public testing::TestWithParam<std::size_t> {
protected:
    const std::size_t n = GetParam();
};

TEST_P(ProbingKernelsOf, NearestToNodesMovesThemToTheNearestPoints) {
    const Floats x = random_floats(n, 12);
    const Floats y = random_floats(n + 15, 13);  // whole registers
    const Floats z = random_floats(n, 14);
    constexpr std::size_t kNodes = 11;
    Floats out(3 * 20, 77.0F);
    const float furthest = kernels::nearest_to_nodes(x.data(), y.data(), z.data(), n, -0.8F, 0.1F,
                                                     0.2F, kNodes, out.data(), 20);
    float expected = 0;
    for (std::size_t k = 0; k < 16; ++k) {
        const float node = -0.8F + 0.1F * static_cast<float>(k);
        std::size_t nearest = n;
        float least = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < n; ++i) {
            const float d = (x[i] - node) * (x[i] - node) + (y[i] - 0.2F) * (y[i] - 0.2F);
            if (d < least) least = d, nearest = i;
        }
        if (k < kNodes) expected = std::max(expected, least);
        if (n == 0) {
            EXPECT_EQ(out[k], 0.0F);
            continue;
        }
        EXPECT_NEAR(out[k], x[nearest] - node, 1e-6F);
        EXPECT_NEAR(out[20 + k], y[nearest] - 0.2F, 1e-6F);
        EXPECT_EQ(out[40 + k], z[nearest]);
    }
    EXPECT_EQ(out[16], 77.0F) << "wrote past the end";
    if (n == 0) {
        EXPECT_EQ(furthest, expected);
    } else {
        EXPECT_NEAR(furthest, expected, 1e-5F);
    }
}

TEST(ProbingKernels, OfEquallyNearPointsTheFirstIsNearest) {
    const Floats x(5, 0.3F);
    const Floats y(5 + 15, 0.1F);
    const Floats z = {1.0F, 2.0F, 3.0F, 4.0F, 5.0F};
    float out[48];
    kernels::nearest_to_nodes(x.data(), y.data(), z.data(), 5, -0.8F, 0.1F, 0.2F, 16, out, 16);
    for (int k = 0; k < 16; ++k) EXPECT_EQ(out[32 + k], 1.0F);
}

TEST(ProbingKernels, NearestToPlaceIsTheFirstOfTheNearest) {
    for (const std::size_t n : {16U, 48U, 208U}) {
        // On a lattice, many are equally near.
        Floats x(n);
        Floats y(n);
        for (std::size_t i = 0; i < n; ++i) {
            x[i] = static_cast<float>(i % 5);
            y[i] = static_cast<float>(i / 5);
        }
        const Floats all_x = x;
        const Floats all_y = y;
        Random random(n);
        for (std::size_t i = 0; i < n; ++i) {
            if (i != 7 && random.uniform(0, 1) < 0.7) x[i] = kInfinite;
        }
        for (std::size_t place = 0; place < n; ++place) {
            const auto squared = [&](std::size_t i) {
                return std::pow(x[i] - all_x[place], 2.0F) + std::pow(y[i] - all_y[place], 2.0F);
            };
            std::size_t first = 7;
            for (std::size_t i = n; i-- > 0;) {
                if (squared(i) <= squared(first)) first = i;
            }
            EXPECT_EQ(kernels::nearest_to_place(x.data(), y.data(), n, all_x[place], all_y[place]),
                      first);
        }
    }
}

TEST(ProbingKernels, NothingIsNearestWhereThereIsNothing) {
    const Floats nowhere(32, kInfinite);
    EXPECT_EQ(kernels::nearest_to_place(nowhere.data(), nowhere.data(), 32, 0.5F, 0.5F), 32U);
    EXPECT_EQ(kernels::nearest_to_place(nowhere.data(), nowhere.data(), 0, 0.5F, 0.5F), 0U);
}

TEST_P(ProbingKernelsOf, ConvolveAgreesWithItsDefinition) {
    constexpr int kReach = 2;
    constexpr int kStride = 3;
    const Floats taps = {0.5F, -1.0F, 2.0F, 0.25F, 3.0F};
    const Floats in = random_floats(n + 2 * kReach * kStride, 13);
    Floats out(n + 1, 7.0F);
    const float* middle = in.data() + kReach * kStride;
    kernels::convolve(middle, out.data(), n, kStride, taps.data() + kReach, kReach);
    for (std::size_t i = 0; i < n; ++i) {
        double expected = 0;
        for (int k = -kReach; k <= kReach; ++k) {
            expected += double{taps[static_cast<std::size_t>(k + kReach)]} *
                        middle[static_cast<std::ptrdiff_t>(i) + k * kStride];
        }
        ASSERT_NEAR(out[i], expected, 1e-4);
    }
    EXPECT_EQ(out[n], 7.0F) << "wrote past the end";
}

TEST_P(ProbingKernelsOf, PointsAreAddedToTheCellsTheyLieIn) {
    constexpr float kStep = 0.25F;
    constexpr int kSide = 9;
    const Floats x = random_floats(n, 21);
    const Floats y = random_floats(n, 22);
    const Floats z = random_floats(n, 23);
    for (const int rows : {kSide, 1}) {
        const auto size = static_cast<std::size_t>(4 * kSide * rows);
        Floats expected(size, 0.0F);
        Floats cells(size + 1, 0.0F);
        cells.back() = 7.0F;
        kernels::add_to_cells(x.data(), y.data(), z.data(), n, kStep, kSide, rows, cells.data());
        const auto cell_of = [&](float value, int count) {
            return std::clamp(static_cast<int>(std::floor(value / kStep + 0.5F)) + count / 2, 0,
                              count - 1);
        };
        for (std::size_t i = 0; i < n; ++i) {
            float* to = expected.data() + 4 * (cell_of(y[i], rows) * kSide + cell_of(x[i], kSide));
            to[0] += 1;
            to[1] += x[i];
            to[2] += y[i];
            to[3] += z[i];
        }
        for (std::size_t k = 0; k < size; ++k) ASSERT_NEAR(cells[k], expected[k], 1e-5);
        EXPECT_EQ(cells.back(), 7.0F) << "wrote past the end";
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, ProbingKernelsOf,
                         testing::Values(0, 1, 7, 8, 15, 16, 17, 31, 64, 193, 500));

}  // namespace
}  // namespace lpf
