#include "core/base/gaussian_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace lpf::kernels {
namespace {

struct Cloud {
    std::vector<float> x, y, z, weight;

    explicit Cloud(std::size_t n) {
        Random random(3, 0);
        for (std::size_t i = 0; i < n; ++i) {
            for (std::vector<float>* axis : {&x, &y, &z}) {
                axis->push_back(static_cast<float>(random.uniform(-2.5, 2.5)));
            }
            weight.push_back(static_cast<float>(random.uniform(0.1, 2.0)));
        }
    }

    [[nodiscard]] double squared(std::size_t i, const float place[3], double sharpness) const {
        const double dx = double{x[i]} - double{place[0]};
        const double dy = double{y[i]} - double{place[1]};
        const double dz = double{z[i]} - double{place[2]};
        return sharpness * sharpness * (dx * dx + dy * dy + dz * dz);
    }
};

double exact(double squared) { return squared <= 9 ? std::exp(-squared / 2) : 0.0; }

TEST(GaussianKernels, SumIsThatOfGaussians) {
    const float place[3] = {0.3F, -0.4F, 0.1F};
    for (const std::size_t n : {0U, 1U, 5U, 16U, 17U, 400U}) {
        const Cloud cloud(n);
        for (const float sharpness : {1.0F, 2.5F}) {
            double expected = 0;
            for (std::size_t i = 0; i < n; ++i) {
                expected += exact(cloud.squared(i, place, double{sharpness}));
            }
            const float sum =
                gaussian_sum(place, sharpness, cloud.x.data(), cloud.y.data(), cloud.z.data(), n);
            EXPECT_NEAR(double{sum}, expected, 0.005 * static_cast<double>(n)) << n;
            EXPECT_NEAR(double{sum}, expected, 0.03 * expected + 0.005) << n;
        }
    }
}

TEST(GaussianKernels, CountsAPointOnThePlaceOnceAndNothingBeyondTheReach) {
    const float place[3] = {1.0F, 2.0F, 3.0F};
    const float x[2] = {1.0F, 1.0F};
    const float y[2] = {2.0F, 2.0F};
    const float z[2] = {3.0F, 6.01F};
    EXPECT_EQ(gaussian_sum(place, 1.0F, x, y, z, 2), 1.0F);
    EXPECT_GT(gaussian_sum(place, 0.9F, x, y, z, 2), 1.0F);
}

TEST(GaussianKernels, MomentsAreWeightedByGaussians) {
    const float place[3] = {-0.2F, 0.5F, 0.0F};
    const Cloud cloud(203);
    const GaussianMoments m = gaussian_moments(place, cloud.x.data(), cloud.y.data(),
                                               cloud.z.data(), cloud.weight.data(), cloud.x.size());
    double weight = 0;
    double along_x = 0;
    double by_chance = 0;
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
        const double squared = cloud.squared(i, place, 1.0);
        const double w = double{cloud.weight[i]} * exact(squared);
        weight += w;
        along_x += w * (double{cloud.x[i]} - double{place[0]});
        by_chance += w * w * squared;
    }
    EXPECT_NEAR(double{m.weight}, weight, 0.03 * weight);
    EXPECT_NEAR(double{m.x}, along_x, 0.03 * weight);
    EXPECT_NEAR(double{m.by_chance}, by_chance, 0.06 * by_chance);
}

TEST(GaussianKernels, MomentsOfAPairPointFromOneToTheOther) {
    const float place[3] = {0.0F, 0.0F, 0.0F};
    const float x[1] = {0.0F};
    const float y[1] = {-1.0F};
    const float z[1] = {0.5F};
    const float weight[1] = {4.0F};
    const GaussianMoments m = gaussian_moments(place, x, y, z, weight, 1);
    EXPECT_EQ(m.x, 0.0F);
    EXPECT_FLOAT_EQ(m.y, -m.weight);
    EXPECT_FLOAT_EQ(m.z, 0.5F * m.weight);
    EXPECT_FLOAT_EQ(m.by_chance, 1.25F * m.weight * m.weight);
}

TEST(GaussianKernels, MeanIsThatOfAllPointsUnderGaussians) {
    const float place[3] = {0.2F, 0.1F, -0.4F};
    constexpr float kSharpness = 0.8F;
    for (const std::size_t n : {0U, 1U, 16U, 203U}) {
        const Cloud cloud(n);
        const GaussianMean m =
            gaussian_mean(place, kSharpness, cloud.x.data(), cloud.y.data(), cloud.z.data(), n);
        double weight = 0;
        double x = 0;
        double z = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double w = std::exp(-cloud.squared(i, place, double{kSharpness}) / 2);
            weight += w;
            x += w * double{cloud.x[i]};
            z += w * double{cloud.z[i]};
        }
        const double tolerance = 1e-5 * (1 + weight);
        EXPECT_NEAR(double{m.weight}, weight, tolerance);
        EXPECT_NEAR(double{m.x}, x, tolerance);
        EXPECT_NEAR(double{m.z}, z, tolerance);
    }
}

}  // namespace
}  // namespace lpf::kernels
