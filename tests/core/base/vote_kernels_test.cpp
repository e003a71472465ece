#include "core/base/vote_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/exponential.h"
#include "core/base/random.h"

namespace lpf {
namespace {

using Floats = std::vector<float>;

Floats random_floats(std::size_t n, std::uint64_t seed, double scale = 1) {
    Random random(seed);
    Floats values(n);
    for (float& value : values) value = static_cast<float>(scale * random.normal());
    return values;
}

TEST(Exponential, AgreesWithTheLibrary) {
    for (float v = 0; v > -80; v -= 0.0137F) {
        const double expected = std::exp(double{v});
        ASSERT_NEAR(double{exponential(v)}, expected, 2e-7 * (1 - double{v}) * expected) << v;
    }
    EXPECT_EQ(exponential(0.0F), 1.0F);
    EXPECT_LT(exponential(-1e30F), 1e-37F);
}

/// Sizes below, at and above whole vectors.
class VoteKernelsOf : public testing::TestWithParam<std::size_t> {
protected:
    const std::size_t n = GetParam();
    const Floats x = random_floats(n, 1, 0.6);
    const Floats y = random_floats(n, 2, 0.6);
};

constexpr int kColumns = 5;
constexpr int kRows = 4;
constexpr kernels::Image kImage{.values = nullptr,
                                .columns = kColumns,
                                .rows = kRows,
                                .scale_x = 2,
                                .offset_x = 2,
                                .scale_y = 1.5F,
                                .offset_y = 1.5F};

/// What lies at (x, y) of an image, of which `values` is the first value and the next is `stride`
/// on.
double value_at(float x, float y, const float* values, int stride) {
    const double column = std::clamp(2.0 * double{x} + 2, 0.0, kColumns - 1.0);
    const double row = std::clamp(1.5 * double{y} + 1.5, 0.0, kRows - 1.0);
    const int left = std::min(static_cast<int>(column), kColumns - 2);
    const int low = std::min(static_cast<int>(row), kRows - 2);
    const auto at = [&](int k, int r) { return double{values[stride * (r * kColumns + k)]}; };
    const double lower = at(left, low) + (column - left) * (at(left + 1, low) - at(left, low));
    const double upper =
        at(left, low + 1) + (column - left) * (at(left + 1, low + 1) - at(left, low + 1));
    return lower + (row - low) * (upper - lower);
}

TEST_P(VoteKernelsOf, ImagesAreReadBilinearlyAndHeldAtTheRim) {
    const Floats values = random_floats(4 * kColumns * kRows, 3);
    kernels::Image image = kImage;
    image.values = values.data();
    Floats one(n + 1, 7.0F);
    kernels::read_image(image, x.data(), y.data(), n, one.data());
    Floats three[3] = {Floats(n + 1, 7.0F), Floats(n + 1, 7.0F), Floats(n + 1, 7.0F)};
    float* const out[3] = {three[0].data(), three[1].data(), three[2].data()};
    kernels::read_three(image, x.data(), y.data(), n, out);
    for (std::size_t i = 0; i < n; ++i) {
        ASSERT_NEAR(one[i], value_at(x[i], y[i], values.data(), 1), 1e-5);
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(three[c][i], value_at(x[i], y[i], values.data() + c, 4), 1e-5);
        }
    }
    for (const Floats* values_out : {&one, &three[0], &three[1], &three[2]}) {
        EXPECT_EQ((*values_out)[n], 7.0F) << "wrote past the end";
    }
}

TEST_P(VoteKernelsOf, WhatIsAddedToAnImageIsSharedOutWhole) {
    Floats weight[4];
    for (std::size_t c = 0; c < 4; ++c) weight[c] = random_floats(n, 4 + c);
    const float* const weights[4] = {weight[0].data(), weight[1].data(), weight[2].data(),
                                     weight[3].data()};
    Floats values(4 * kColumns * kRows, 0.0F);
    kernels::add_to_four(kImage, x.data(), y.data(), weights, n, values.data());
    for (std::size_t c = 0; c < 4; ++c) {
        double added = 0;
        double kept = 0;
        for (const float w : weight[c]) added += double{w};
        for (std::size_t k = c; k < values.size(); k += 4) kept += double{values[k]};
        EXPECT_NEAR(kept, added, 1e-4 * (1 + static_cast<double>(n)));
    }
}

TEST(VoteKernels, ANodeOfTheImageTakesAllThatFallsOnIt) {
    Floats values(4 * kColumns * kRows, 0.0F);
    const float x = 0.5F;              // column 3
    const float y = -1.0F + 4.0F / 3;  // row 2
    const float weight[4] = {7, 8, 9, 10};
    const float* const weights[4] = {&weight[0], &weight[1], &weight[2], &weight[3]};
    kernels::add_to_four(kImage, &x, &y, weights, 1, values.data());
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_NEAR(values[4 * (2 * kColumns + 3) + c], weight[c], 1e-5);
    }
}

TEST_P(VoteKernelsOf, ChangesOfPolynomialsAreDifferencesOfTheirValues) {
    const Floats dx = random_floats(n, 5, 0.1);
    const Floats dy = random_floats(n, 6, 0.1);
    const float c[6] = {9, 0.3F, -0.2F, 0.5F, 0.7F, -0.4F};
    Floats surface(n, 1.0F);
    Floats curve(n, 1.0F);
    kernels::add_parabola_change(c, -2.0F, x.data(), y.data(), dx.data(), dy.data(), n,
                                 surface.data());
    kernels::add_cubic_change(c, 3.0F, x.data(), dx.data(), n, curve.data());
    const auto parabola = [&](double u, double v) {
        return double{c[1]} * u + double{c[2]} * v + double{c[3]} * u * u + double{c[4]} * u * v +
               double{c[5]} * v * v;
    };
    const auto cubic = [&](double u) {
        return double{c[1]} * u + double{c[2]} * u * u + double{c[3]} * u * u * u;
    };
    for (std::size_t i = 0; i < n; ++i) {
        const double u = double{x[i]};
        const double v = double{y[i]};
        ASSERT_NEAR(surface[i],
                    1 - 2 * (parabola(u + double{dx[i]}, v + double{dy[i]}) - parabola(u, v)),
                    1e-4);
        ASSERT_NEAR(curve[i], 1 + 3 * (cubic(u + double{dx[i]}) - cubic(u)), 1e-4);
    }
}

TEST_P(VoteKernelsOf, WeightsAreReliabilityFadeDensityAndLikelihood) {
    const Floats move = random_floats(n, 7, 0.3);
    Floats weight = random_floats(n, 8, 2);
    const Floats density = weight;
    kernels::weigh({.reliability = 1.5F, .fades = true, .least_density = 0.1F, .precision = 4},
                   x.data(), y.data(), move.data(), move.data(), move.data(), n, weight.data());
    for (std::size_t i = 0; i < n; ++i) {
        const double inside = 1 - double{x[i]} * double{x[i]} - double{y[i]} * double{y[i]};
        const double squared = 3 * double{move[i]} * double{move[i]};
        const double expected = inside <= 0 ? 0.0
                                            : 1.5 * inside * inside *
                                                  std::clamp(double{density[i]}, 0.1, 1.0) *
                                                  std::pow(1 + 4 * squared / 8, -4);
        ASSERT_NEAR(weight[i], expected, 1e-5);
    }
}

TEST_P(VoteKernelsOf, RotateIsAProductWithTheMatrix) {
    const float axes[9] = {1, 2, 3, -1, 0.5F, 2, 4, -3, 0.25F};
    Floats p[3] = {x, y, random_floats(n, 9)};
    const Floats z = p[2];
    kernels::rotate(axes, p[0].data(), p[1].data(), p[2].data(), n);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_NEAR(p[c][i],
                        axes[3 * c] * x[i] + axes[3 * c + 1] * y[i] + axes[3 * c + 2] * z[i], 1e-5);
        }
    }
}

TEST_P(VoteKernelsOf, VotesAreSummedWithinTheirLimits) {
    const Floats move = random_floats(n, 10);
    Floats weight(n);
    std::vector<unsigned> point(n);
    for (std::size_t i = 0; i < n; ++i) {
        weight[i] = i % 3 == 0 ? 0.0F : i % 3 == 1 ? 1e-9F : 5.0F;
        point[i] = static_cast<unsigned>(i / 2);
    }
    constexpr float kScale = 65536.0F;
    std::vector<std::int64_t> sums(4 * (n + 1), 0);
    kernels::add_votes(point.data(), weight.data(), move.data(), move.data(), move.data(), n,
                       kScale, 0.25F, 2.0F, sums.data());
    std::vector<double> expected(4 * (n + 1), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        const double counted = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.25 : 2.0;
        expected[4 * point[i]] += counted * double{kScale};
        for (std::size_t c = 1; c < 4; ++c) {
            expected[4 * point[i] + c] += counted * double{kScale} * double{move[i]};
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        ASSERT_NEAR(static_cast<double>(sums[k]), expected[k], 4) << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, VoteKernelsOf, testing::Values(0, 1, 15, 16, 17, 64, 200));

}  // namespace
}  // namespace lpf
