#include "core/base/crease_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/blur.h"
#include "core/base/random.h"

namespace lpf {
namespace {

using Floats = std::vector<float>;

/// Points about a creased surface; sizes below, at and above whole vectors and blocks.
class CreaseKernelsOf : public testing::TestWithParam<std::size_t> {
protected:
    CreaseKernelsOf() {
        Random random(n, 5);
        for (std::size_t i = 0; i < n; ++i) {
            for (Floats* values : {&x, &y, &z}) {
                values->push_back(static_cast<float>(random.uniform(-1, 1)));
            }
            off.push_back(static_cast<float>(random.uniform()));
        }
    }

    [[nodiscard]] BlurredDistance blurred(std::size_t i) const {
        return blur(surface.normal_x * x[i] + surface.normal_y * y[i] - surface.at, surface.noise);
    }

    const std::size_t n = GetParam();
    const float c[6] = {0.1F, 0.3F, -0.2F, 0.5F, 0.7F, -0.4F};
    const kernels::CreasedSurface surface{c, -0.8F, 0.6F, 0.8F, 0.05F, 0.1F};
    Floats x, y, z, off;
};

TEST_P(CreaseKernelsOf, OffsetsAreSquaredHeightsAboveTheSurface) {
    Floats out(n);
    kernels::offsets_from_crease(surface, x.data(), y.data(), z.data(), n, out.data());
    for (std::size_t i = 0; i < n; ++i) {
        const double u = double{x[i]};
        const double v = double{y[i]};
        const double height = double{c[0]} + double{c[1]} * u + double{c[2]} * v +
                              double{c[3]} * u * u + double{c[4]} * u * v + double{c[5]} * v * v -
                              0.8 * double{blurred(i).distance};
        ASSERT_NEAR(out[i], std::pow(double{z[i]} - height, 2), 1e-5);
    }
}

TEST_P(CreaseKernelsOf, MomentsAreThoseOfTheMembers) {
    for (const std::size_t stride : {1U, 3U}) {
        double out[kernels::kCreaseRows * kernels::kCreaseRows];
        kernels::crease_moments(surface, x.data(), y.data(), z.data(), off.data(), 0.7F, n, stride,
                                out);
        double expected[kernels::kCreaseRows][kernels::kCreaseRows] = {};
        for (std::size_t i = 0; i < n; i += stride) {
            if (off[i] > 0.7F) continue;
            const double u = double{x[i]};
            const double v = double{y[i]};
            const BlurredDistance d = blurred(i);
            const double along = double{surface.normal_x} * v - double{surface.normal_y} * u;
            const double rows[] = {1,
                                   u,
                                   v,
                                   u * u,
                                   u * v,
                                   v * v,
                                   double{d.distance},
                                   double{d.sign},
                                   double{d.sign} * along,
                                   double{z[i]}};
            for (int a = 0; a < kernels::kCreaseRows; ++a) {
                for (int b = 0; b <= a; ++b) expected[a][b] += rows[a] * rows[b];
            }
        }
        for (int a = 0; a < kernels::kCreaseRows; ++a) {
            for (int b = 0; b <= a; ++b) {
                ASSERT_NEAR(out[a * kernels::kCreaseRows + b], expected[a][b],
                            1e-5 * (1 + static_cast<double>(n)));
            }
        }
    }
}

TEST_P(CreaseKernelsOf, SubtractLeavesTheRootOfTheOffset) {
    Floats left = z;
    left.push_back(7.0F);
    Floats squared(n);
    kernels::subtract_crease(surface, x.data(), y.data(), n, left.data());
    kernels::offsets_from_crease(surface, x.data(), y.data(), z.data(), n, squared.data());
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(left[i] * left[i], squared[i], 1e-5);
    EXPECT_EQ(left[n], 7.0F) << "wrote past the end";
}

TEST_P(CreaseKernelsOf, LineSumsAreThoseOfTheDistances) {
    constexpr std::size_t kLines = 32;
    Floats normal_x, normal_y, at;
    for (std::size_t k = 0; k < kLines; ++k) {
        normal_x.push_back(std::cos(0.2F * static_cast<float>(k)));
        normal_y.push_back(std::sin(0.2F * static_cast<float>(k)));
        at.push_back(0.02F * static_cast<float>(k) - 0.3F);
    }
    Floats out(5 * kLines + 1, 7.0F);
    kernels::line_sums({normal_x.data(), normal_y.data(), at.data(), kLines}, x.data(), y.data(),
                       z.data(), off.data(), n, out.data());
    for (std::size_t k = 0; k < kLines; ++k) {
        double expected[5] = {};
        for (std::size_t i = 0; i < n; ++i) {
            const double d =
                std::abs(double{normal_x[k]} * x[i] + double{normal_y[k]} * y[i] - double{at[k]});
            const double factors[5] = {1, double{x[i]}, double{y[i]}, d, double{z[i]}};
            for (int row = 0; row < 5; ++row) expected[row] += double{off[i]} * d * factors[row];
        }
        for (std::size_t row = 0; row < 5; ++row) {
            EXPECT_NEAR(out[row * kLines + k], expected[row], 1e-5 * (1 + double(n)));
        }
    }
    EXPECT_EQ(out.back(), 7.0F) << "wrote past the end";
}

INSTANTIATE_TEST_SUITE_P(Sizes, CreaseKernelsOf, testing::Values(0, 1, 16, 17, 255, 256, 257, 700));

}  // namespace
}  // namespace lpf
