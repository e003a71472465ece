#include "core/base/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

using Floats = std::vector<float>;

Floats random_floats(std::size_t n, std::uint64_t seed) {
    Random random(seed);
    Floats values(n);
    for (float& value : values) value = static_cast<float>(random.normal());
    return values;
}

/// Sizes below, at and above whole vectors.
class KernelsOf : public testing::TestWithParam<std::size_t> {
protected:
    const std::size_t n = GetParam();
    const double tolerance = 1e-5 * std::sqrt(static_cast<double>(n) + 1);
};

TEST_P(KernelsOf, DotAndSquaredDistanceAgreeWithDoubles) {
    const Floats a = random_floats(n, 1);
    const Floats b = random_floats(n, 2);
    double dot = 0;
    double squared = 0;
    for (std::size_t i = 0; i < n; ++i) {
        dot += double{a[i]} * b[i];
        squared += std::pow(double{a[i]} - b[i], 2);
    }
    EXPECT_NEAR(kernels::dot(a.data(), b.data(), n), dot, tolerance);
    EXPECT_NEAR(kernels::squared_distance(a.data(), b.data(), n), squared, 10 * tolerance);
}

TEST_P(KernelsOf, CombineRowsAddsUpSomeRows) {
    const std::size_t stride = n + 3;
    const Floats rows = random_floats(4 * stride, 3);
    const unsigned chosen[] = {3, 0, 2};
    const float coefficient[] = {0.5F, -2.0F, 1.25F};
    for (const std::size_t count : {0U, 1U, 3U}) {
        Floats out(n + 1, 77.0F);
        kernels::combine_rows(rows.data(), stride, n, chosen, coefficient, count, out.data());
        for (std::size_t i = 0; i < n; ++i) {
            double expected = 0;
            for (std::size_t k = 0; k < count; ++k) {
                expected += double{coefficient[k]} * double{rows[chosen[k] * stride + i]};
            }
            ASSERT_NEAR(out[i], expected, 1e-5);
        }
        EXPECT_EQ(out[n], 77.0F) << "wrote past the end";
    }
}

/// Entry (i, j) of a product of count x inner with inner x n values.
double entry_of_product(const Floats& left, const Floats& right, std::size_t inner, std::size_t n,
                        std::size_t i, std::size_t j) {
    double sum = 0;
    for (std::size_t k = 0; k < inner; ++k) {
        sum += double{left[i * inner + k]} * double{right[k * n + j]};
    }
    return sum;
}

TEST_P(KernelsOf, AddProductAddsTheProductOfTwoMatrices) {
    for (const std::size_t count : {1U, 5U, 8U, 11U}) {
        for (const std::size_t inner : {0U, 1U, 13U}) {
            const Floats left = random_floats(count * inner, 25);
            const Floats right = random_floats(inner * n, 26);
            const Floats before = random_floats(count * n + 1, 27);
            Floats out = before;
            kernels::add_product(left.data(), count, inner, right.data(), n, out.data());
            for (std::size_t i = 0; i < count * n; ++i) {
                const double product = entry_of_product(left, right, inner, n, i / n, i % n);
                ASSERT_NEAR(out[i], before[i] + product, 1e-5);
            }
            EXPECT_EQ(out.back(), before.back()) << "wrote past the end";
        }
    }
}

TEST(Kernels, MultiplyIsTheProductWithAMatrixInPanels) {
    for (const std::size_t columns : {16U, 32U, 48U, 80U, 208U}) {
        for (const std::size_t count : {1U, 5U, 8U, 11U}) {
            for (const std::size_t inner : {0U, 1U, 13U, 128U, 300U}) {
                const Floats left = random_floats(count * inner, 25);
                const Floats right = random_floats(inner * columns, 26);
                Floats panels(right.size() + 1, 77.0F);
                kernels::to_panels(right.data(), inner, columns, panels.data());
                EXPECT_EQ(panels.back(), 77.0F) << "wrote past the end";
                Floats out(count * columns + 1, 77.0F);
                kernels::multiply(left.data(), count, inner, panels.data(), columns, out.data());
                for (std::size_t i = 0; i < count * columns; ++i) {
                    const double product =
                        entry_of_product(left, right, inner, columns, i / columns, i % columns);
                    ASSERT_NEAR(out[i], product, 1e-4);
                }
                EXPECT_EQ(out.back(), 77.0F) << "wrote past the end";
            }
        }
    }
}

TEST(Kernels, PanelsAreColumnsSideBySide) {
    // Two rows of 40 columns: 32 of each row, then the 8 that are left of each.
    Floats matrix(80);
    std::iota(matrix.begin(), matrix.end(), 0.0F);
    Floats panels(80);
    kernels::to_panels(matrix.data(), 2, 40, panels.data());
    EXPECT_EQ(panels[0], 0.0F);
    EXPECT_EQ(panels[31], 31.0F);
    EXPECT_EQ(panels[32], 40.0F);
    EXPECT_EQ(panels[64], 32.0F);
    EXPECT_EQ(panels[72], 72.0F);
}

TEST_P(KernelsOf, AddScaledAddsAndStopsAtTheEnd) {
    const Floats in = random_floats(n + 1, 5);
    Floats out = random_floats(n + 1, 6);
    const Floats before = out;
    kernels::add_scaled(-2.5F, in.data(), out.data(), n);
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(out[i], before[i] - 2.5F * in[i], 1e-5);
    EXPECT_EQ(out[n], before[n]);
}

TEST_P(KernelsOf, PairMomentsAgreeWithDoubles) {
    const Floats u = random_floats(3 * n, 7);
    const Floats v = random_floats(3 * n, 8);
    const Floats w = random_floats(3 * n, 9);
    const kernels::PairMoments moments = kernels::pair_moments(u.data(), v.data(), w.data(), n);
    for (std::size_t r = 0; r < 3; ++r) {
        double a = 0;
        double b = 0;
        for (std::size_t i = r * n; i < (r + 1) * n; ++i) {
            a += double{u[i]} + v[i];
            b += double{u[i]} + w[i];
        }
        EXPECT_NEAR(moments.a[r], a, 4 * tolerance);
        EXPECT_NEAR(moments.b[r], b, 4 * tolerance);
        for (std::size_t c = 0; c < 3; ++c) {
            double ab = 0;
            for (std::size_t i = 0; i < n; ++i) {
                ab += (double{u[r * n + i]} + v[r * n + i]) * (double{u[c * n + i]} + w[c * n + i]);
            }
            EXPECT_NEAR(moments.ab[3 * r + c], ab, 10 * tolerance);
        }
    }
}

TEST_P(KernelsOf, SecondMomentsAgreeWithDoubles) {
    const Floats p[3] = {random_floats(n, 10), random_floats(n, 11), random_floats(n, 12)};
    float moments[9];
    kernels::second_moments(p[0].data(), p[1].data(), p[2].data(), n, moments);
    int next = 0;
    for (const Floats& axis : p) {
        double sum = 0;
        for (const float value : axis) sum += value;
        EXPECT_NEAR(moments[next++], sum, 4 * tolerance);
    }
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = r; c < 3; ++c) {
            EXPECT_NEAR(moments[next++], kernels::dot(p[r].data(), p[c].data(), n), 4 * tolerance);
        }
    }
}

TEST_P(KernelsOf, ParabolaMomentsAreThoseOfThePointsWithinTheLimit) {
    const Floats x = random_floats(n, 20);
    const Floats y = random_floats(n, 21);
    const Floats z = random_floats(n, 22);
    const Floats off = random_floats(n, 23);
    float moments[21];
    kernels::parabola_moments(x.data(), y.data(), z.data(), off.data(), 0.2F, n, moments);
    int next = 0;
    const auto sum = [&](int a, int b, bool with_z) {
        double total = 0;
        for (std::size_t i = 0; i < n; ++i) {
            if (off[i] > 0.2F) continue;
            total += std::pow(double{x[i]}, a) * std::pow(double{y[i]}, b) *
                     (with_z ? double{z[i]} : 1.0);
        }
        return total;
    };
    for (int degree = 0; degree <= 4; ++degree) {
        for (int b = 0; b <= degree; ++b) {
            EXPECT_NEAR(moments[next++], sum(degree - b, b, false), 20 * tolerance);
        }
    }
    for (int degree = 0; degree <= 2; ++degree) {
        for (int b = 0; b <= degree; ++b) {
            EXPECT_NEAR(moments[next++], sum(degree - b, b, true), 20 * tolerance);
        }
    }
}

TEST_P(KernelsOf, OffsetsAreSquaredDistancesAlongTheNormals) {
    const Floats x = random_floats(n, 24);
    const Floats y = random_floats(n, 25);
    const Floats z = random_floats(n, 26);
    const float c[8] = {0.1F, -0.4F, 0.3F, 0.7F, -0.2F, 0.5F, 0.25F, -0.6F};
    Floats parabola(n + 1, 7.0F);
    Floats cubics(n + 1, 7.0F);
    kernels::offsets_from_parabola(c, x.data(), y.data(), z.data(), n, parabola.data());
    kernels::offsets_from_cubics(c, x.data(), y.data(), z.data(), n, cubics.data());
    for (std::size_t i = 0; i < n; ++i) {
        const double a = x[i];
        const double b = y[i];
        const double height =
            c[0] + c[1] * a + c[2] * b + c[3] * a * a + c[4] * a * b + c[5] * b * b;
        EXPECT_NEAR(parabola[i], std::pow(z[i] - height, 2), 1e-4);
        const double cubic_y = c[0] + c[1] * a + c[2] * a * a + c[3] * a * a * a;
        const double cubic_z = c[4] + c[5] * a + c[6] * a * a + c[7] * a * a * a;
        EXPECT_NEAR(cubics[i], std::pow(b - cubic_y, 2) + std::pow(z[i] - cubic_z, 2), 1e-4);
    }
    EXPECT_EQ(parabola[n], 7.0F) << "wrote past the end";
    EXPECT_EQ(cubics[n], 7.0F) << "wrote past the end";
}

TEST_P(KernelsOf, ToFrameIsTheTransposedAxesTimesTheOffset) {
    const Floats p[3] = {random_floats(n, 14), random_floats(n, 15), random_floats(n, 16)};
    Floats out[3] = {p[0], p[1], p[2]};
    const float axes[9] = {1, 2, 3, 4, 5, 6, 7, 8, 10};  // row-major, nothing alike
    const float origin[3] = {0.5F, -1.5F, 2.5F};
    kernels::to_frame(axes, origin, out[0].data(), out[1].data(), out[2].data(), n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t column = 0; column < 3; ++column) {
            double expected = 0;
            for (std::size_t row = 0; row < 3; ++row) {
                expected += double{axes[3 * row + column]} * (double{p[row][i]} - origin[row]);
            }
            ASSERT_NEAR(out[column][i], expected, 1e-4);
        }
    }
}

TEST_P(KernelsOf, GatherBallKeepsThePointsInsideWithTheirNumbers) {
    std::vector<double> p[3];
    Random random(17);
    for (auto& axis : p) {
        for (std::size_t i = 0; i < n; ++i) axis.push_back(5 + random.normal());
    }
    const double centre[3] = {5.1, 4.9, 5.2};
    const double scale = 0.5;
    const float limit = 0.7F;
    const std::size_t room = n + kernels::kGatherSlack;
    Floats out[3] = {Floats(room), Floats(room), Floats(room)};
    std::vector<unsigned> index(room);
    const std::size_t kept =
        kernels::gather_ball(p[0].data(), p[1].data(), p[2].data(), n, centre, scale, limit, 100,
                             out[0].data(), out[1].data(), out[2].data(), index.data());
    std::size_t expected = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double squared = 0;
        for (std::size_t c = 0; c < 3; ++c) squared += std::pow(scale * (p[c][i] - centre[c]), 2);
        if (squared > 0.49) continue;
        ASSERT_LT(expected, kept);
        EXPECT_EQ(index[expected], 100 + i);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(out[c][expected], scale * (p[c][i] - centre[c]), 1e-6);
        }
        ++expected;
    }
    EXPECT_EQ(kept, expected);
}

TEST_P(KernelsOf, BlocksAreThoseOfARaster) {
    constexpr int kSide = 7;
    const Floats x = random_floats(n, 17);
    const Floats y = random_floats(n, 18);
    std::vector<unsigned> out(n + 1, 77U);
    kernels::block_numbers(x.data(), y.data(), 1.1F, kSide, n, out.data());
    const auto along = [&](float value) {
        const float share = (value / 1.1F + 1) / 2;
        return std::clamp(static_cast<int>(std::floor(share * kSide)), 0, kSide - 1);
    };
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(out[i], static_cast<unsigned>(along(y[i]) * kSide + along(x[i])));
    }
    EXPECT_EQ(out[n], 77U) << "wrote past the end";
}

INSTANTIATE_TEST_SUITE_P(Sizes, KernelsOf, testing::Values(0, 1, 3, 8, 15, 16, 17, 64, 193),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace lpf
