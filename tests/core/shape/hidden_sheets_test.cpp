#include "core/shape/hidden_sheets.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/base/random.h"

namespace lpf {
namespace {

/// What 100 balls of 300 points each hold whose heights over a plane are drawn like this.
HiddenSheets find_in(const std::function<double(Random&)>& draw_height) {
    Random random(5);
    std::vector<Spread> spreads;
    std::vector<double> heights;
    NearPoints ball;
    ball.reserve(300);
    ball.size = 300;
    for (int k = 0; k < 100; ++k) {
        for (std::size_t i = 0; i < ball.size; ++i) {
            ball.x[i] = static_cast<float>(random.uniform(-1, 1));
            ball.y[i] = static_cast<float>(random.uniform(-1, 1));
            ball.z[i] = static_cast<float>(0.1 * draw_height(random));
        }
        spreads.push_back(spread_in(ball, heights));
    }
    return find_hidden_sheets(spreads);
}

TEST(HiddenSheets, AreNotFoundInNoise) {
    const HiddenSheets found = find_in([](Random& random) { return random.normal(); });
    EXPECT_EQ(found.share, 0.0);
    EXPECT_FALSE(found.is_flat_noise);
}

TEST(HiddenSheets, AreNotFoundInNoiseWithLongTails) {
    const HiddenSheets found = find_in(
        [](Random& random) { return random.normal() * (random.uniform() < 0.1 ? 2.0 : 0.5); });
    EXPECT_EQ(found.share, 0.0);
    EXPECT_FALSE(found.is_flat_noise);
}

class HiddenSheetsApart : public testing::TestWithParam<double> {};

TEST_P(HiddenSheetsApart, HaveTheirShareOfTheVariance) {
    const double half = GetParam() / 2;
    const HiddenSheets found = find_in(
        [&](Random& random) { return random.normal() + (random.uniform() < 0.5 ? half : -half); });
    EXPECT_FALSE(found.is_flat_noise);
    EXPECT_NEAR(found.share, half * half / (1 + half * half), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Sigmas, HiddenSheetsApart, testing::Values(2.5, 3.0, 3.5),
                         [](const auto& test) {
                             return "Tenths" + std::to_string(static_cast<int>(10 * test.param));
                         });

TEST(HiddenSheets, AreNotFoundInEvenNoise) {
    const HiddenSheets found = find_in([](Random& random) { return random.uniform(-1, 1); });
    EXPECT_TRUE(found.is_flat_noise);
    EXPECT_EQ(found.share, 0.0);
}

TEST(HiddenSheets, AreNotFoundInEvenNoiseOfTwoCoordinates) {
    const HiddenSheets found =
        find_in([](Random& random) { return random.uniform(-1, 1) + 0.4 * random.uniform(-1, 1); });
    EXPECT_TRUE(found.is_flat_noise);
    EXPECT_EQ(found.share, 0.0);
}

TEST(HiddenSheets, AreNotFoundInNothing) {
    const HiddenSheets found = find_hidden_sheets({});
    EXPECT_EQ(found.share, 0.0);
    EXPECT_FALSE(found.is_flat_noise);
}

}  // namespace
}  // namespace lpf
