#include "tests/support/solids.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "tests/support/shapes.h"

namespace lpf::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct Known {
    std::string name;
    SolidPtr solid;
    double area;
    Vector3d inside;
    double depth;  // of that point
};

std::vector<Known> known_solids() {
    return {{"Ball", ball({1, 2, 3}, 2), 16 * kPi, {1, 2, 4}, 1},
            {"Capsule", capsule({0, 0, 0}, {0, 3, 0}, 0.5), 4 * kPi, {0.1, 1, 0}, 0.4},
            {"Block", block({0, 0, 0}, {1, 2, 3}), 22, {0.5, 1, 0.25}, 0.25},
            {"Ring", ring({0, 0, 1}, 2, 0.5), 4 * kPi * kPi, {2, 0, 1.2}, 0.3}};
}

class SolidOf : public testing::TestWithParam<Known> {};

TEST_P(SolidOf, HasItsAreaAndItsDistances) {
    const Known& known = GetParam();
    EXPECT_NEAR(known.solid->area(), known.area, 1e-9);
    EXPECT_NEAR(known.solid->signed_distance(known.inside), -known.depth, 1e-9);
    EXPECT_GT(known.solid->signed_distance({9, 9, 9}), 0);
}

TEST_P(SolidOf, IsSampledEvenlyOnItsSurface) {
    const Known& known = GetParam();
    Random random(3, 3);
    const Vector3d middle = known.solid->box().center();
    Vector3d mean = Vector3d::Zero();
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
        const Vector3d place = known.solid->sample(random);
        ASSERT_NEAR(known.solid->signed_distance(place), 0, 1e-9);
        ASSERT_LT(known.solid->box().exteriorDistance(place), 1e-9);
        mean += place / kSamples;
    }
    EXPECT_LT((mean - middle).norm(), 0.03 * known.solid->box().diagonal().norm());
}

INSTANTIATE_TEST_SUITE_P(Solids, SolidOf, testing::ValuesIn(known_solids()),
                         [](const auto& test) { return test.param.name; });

TEST(UnionSurface, LeavesOutWhatIsBuried) {
    const PiecePtr one = union_surface({block({0, 0, 0}, {2, 1, 1}), block({1, 0, 0}, {3, 1, 1})});
    EXPECT_NEAR(one->measure(), 14, 0.15) << "a block of 3 x 1 x 1";
    Random random(3, 3);
    for (int i = 0; i < 5000; ++i) {
        const Vector3d p = one->sample(random);
        const bool on_end = p.x() < 1e-9 || p.x() > 3 - 1e-9;
        const bool on_side = std::min({p.y(), 1 - p.y(), p.z(), 1 - p.z()}) < 1e-9;
        ASSERT_TRUE(on_end || on_side);
    }
    EXPECT_NEAR(one->squared_distance({1.5, 0.5, 1.5}), 0.25, 1e-12);
}

TEST(SmallBodies, AreTenWithNoiseAsLargeAsTheirSpacing) {
    const std::vector<TestShape> bodies = make_small_bodies(5);
    ASSERT_EQ(bodies.size(), 10U);
    for (const TestShape& body : bodies) {
        ASSERT_EQ(body.points.cols(), 10000);
        const double spacing = std::sqrt(body.pieces[0]->measure() / 10000);
        const double noise = std::sqrt((body.points - body.clean).squaredNorm() / 30000);
        EXPECT_NEAR(noise, spacing, 0.02 * spacing) << body.name;
        EXPECT_LT(body.distance(body.clean.col(77)), 1e-9) << body.name;
    }
}

}  // namespace
}  // namespace lpf::test
