#include "core/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace lpf {
namespace {

constexpr int kDraws = 200000;

TEST(RandomNumbers, SameSeedAndStreamGiveTheSameNumbers) {
    Random a(7, 3);
    Random b(7, 3);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(a.bits(), b.bits());
}

TEST(RandomNumbers, NeighbouringSeedsAndStreamsDiffer) {
    std::set<std::uint64_t> first;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        for (std::uint64_t stream = 0; stream < 50; ++stream) {
            first.insert(Random(seed, stream).bits());
        }
    }
    EXPECT_EQ(first.size(), 2500U);
}

TEST(RandomNumbers, UniformFillsTheUnitIntervalEvenly) {
    Random random(1);
    std::array<int, 20> bins{};
    for (int i = 0; i < kDraws; ++i) {
        const double value = random.uniform();
        ASSERT_GE(value, 0);
        ASSERT_LT(value, 1);
        ++bins[static_cast<std::size_t>(value * 20)];
    }
    double chi_squared = 0;
    const double expected = kDraws / 20.0;
    for (const int count : bins) chi_squared += std::pow(count - expected, 2) / expected;
    EXPECT_LT(chi_squared, 43.8);  // 19 degrees of freedom, p = 0.001
}

TEST(RandomNumbers, FirstDrawsOfNeighbouringStreamsAreUniformAndUncorrelated) {
    double sum = 0;
    double product = 0;
    double previous = 0.5;
    for (std::uint64_t stream = 0; stream < kDraws; ++stream) {
        const double value = Random(1, stream).uniform();
        sum += value;
        product += (value - 0.5) * (previous - 0.5);
        previous = value;
    }
    EXPECT_NEAR(sum / kDraws, 0.5, 4 / std::sqrt(12.0 * kDraws));
    EXPECT_NEAR(12 * product / kDraws, 0, 4 / std::sqrt(double{kDraws}));
}

TEST(RandomNumbers, UniformKeepsToItsRange) {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const double value = random.uniform(-3, 5);
        ASSERT_GE(value, -3);
        ASSERT_LT(value, 5);
    }
}

TEST(RandomNumbers, BelowReachesEveryNumberAndNoOther) {
    Random random(3);
    std::array<int, 7> counts{};
    for (int i = 0; i < 70000; ++i) ++counts.at(random.below(7));
    for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
    EXPECT_EQ(random.below(1), 0U);
}

TEST(RandomNumbers, NormalHasMeanZeroVarianceOneAndNoSkew) {
    Random random(4);
    double first = 0;
    double second = 0;
    double third = 0;
    double fourth = 0;
    for (int i = 0; i < kDraws; ++i) {
        const double value = random.normal();
        ASSERT_TRUE(std::isfinite(value));
        first += value;
        second += value * value;
        third += value * value * value;
        fourth += std::pow(value, 4);
    }
    EXPECT_NEAR(first / kDraws, 0, 0.01);
    EXPECT_NEAR(second / kDraws, 1, 0.015);
    EXPECT_NEAR(third / kDraws, 0, 0.04);
    EXPECT_NEAR(fourth / kDraws, 3, 0.1);
}

TEST(RandomNumbers, StayInTheirRange) {
    Random random(21);
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {
        const double value = random.uniform(-3.0, 5.0);
        ASSERT_GE(value, -3.0);
        ASSERT_LT(value, 5.0);
        sum += value;
    }
    EXPECT_NEAR(sum / 4000, 1.0, 0.15);
}

}  // namespace
}  // namespace lpf
