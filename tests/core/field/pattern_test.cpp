#include "core/field/pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/random.h"

namespace lpf {
namespace {

struct NamedPattern {
    std::string name;
    Pattern pattern;
};

void PrintTo(const NamedPattern& named, std::ostream* out) { *out << named.name; }

Eigen::Matrix3Xf cross_offsets() {
    Eigen::Matrix3Xf offsets(3, 5);
    offsets << 0, 0.9F, -0.9F, 0, 0,  //
        0, 0, 0, 0.9F, -0.9F,         //
        0, 0.1F, 0.2F, 0.3F, 0.4F;
    return offsets;
}

void expect_invalid(const std::function<void()>& call) {
    try {
        call();
        FAIL() << "no exception";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::InvalidParameter);
        EXPECT_EQ(error.field(), "patternPoints");
    }
}

class PatternOf : public testing::TestWithParam<NamedPattern> {
protected:
    const Pattern& pattern = GetParam().pattern;
};

TEST_P(PatternOf, PointsLieInTheUnitDisk) {
    for (int i = 0; i < pattern.size(); ++i) {
        ASSERT_LE(pattern.point(i).head<2>().norm(), 1.0001F) << "point " << i;
    }
}

TEST_P(PatternOf, ChannelsArePaddedWithZerosToWholeVectors) {
    EXPECT_EQ(pattern.padded_size() % 16, 0);
    EXPECT_GE(pattern.padded_size(), pattern.size());
    EXPECT_LT(pattern.padded_size(), pattern.size() + 16);
    for (int c = 0; c < 3; ++c) {
        for (int i = pattern.size(); i < pattern.padded_size(); ++i) {
            ASSERT_EQ(pattern.channel(c)[i], 0);
        }
    }
}

TEST_P(PatternOf, OrdersItsPointsFromTheCentreOutwards) {
    const std::vector<int>& order = pattern.by_distance();
    ASSERT_EQ(std::set<int>(order.begin(), order.end()).size(),
              static_cast<std::size_t>(pattern.size()));
    EXPECT_EQ(pattern.point(order[0]).head<2>().norm(), 0);
    for (std::size_t i = 1; i < order.size(); ++i) {
        ASSERT_LE(pattern.point(order[i - 1]).head<2>().norm(),
                  pattern.point(order[i]).head<2>().norm() + 1e-6F);
    }
}

TEST_P(PatternOf, StencilsAreAveragesOfItsPoints) {
    Random random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        const auto x = static_cast<float>(random.uniform(-1.3, 1.3));
        const auto y = static_cast<float>(random.uniform(-1.3, 1.3));
        const Pattern::Stencil stencil = pattern.stencil(x, y);
        float sum = 0;
        for (int k = 0; k < 4; ++k) {
            ASSERT_GE(stencil.node[k], 0);
            ASSERT_LT(stencil.node[k], pattern.size());
            ASSERT_GE(stencil.weight[k], -1e-6F);
            sum += stencil.weight[k];
        }
        ASSERT_NEAR(sum, 1, 1e-5) << x << ", " << y;
    }
}

TEST_P(PatternOf, SpacingAgreesWithTheNumberOfPoints) {
    // One point for each square of side tau_s in a disk of area pi.
    const double points = 3.14159 / (pattern.step() * pattern.step());
    EXPECT_NEAR(points / pattern.size(), 1, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PatternOf,
                         testing::Values(NamedPattern{"Grid8", Pattern::grid(8)},
                                         NamedPattern{"Grid9", Pattern::grid(9)},
                                         NamedPattern{"Grid16", Pattern::grid(16)},
                                         NamedPattern{"Grid32", Pattern::grid(32)},
                                         NamedPattern{"Random193", Pattern::random_disk(193, 1)},
                                         NamedPattern{"Random16", Pattern::random_disk(16, 2)},
                                         NamedPattern{"Cross",
                                                      Pattern::from_points(cross_offsets())}),
                         [](const auto& test) { return test.param.name; });

TEST(PatternGrid, HasThePapersNumbersOfPoints) {
    EXPECT_EQ(Pattern::grid(16).size(), 193);
    EXPECT_EQ(Pattern::grid(32).size(), 793);
    EXPECT_EQ(Pattern::grid(64).size(), 3205);
    EXPECT_FLOAT_EQ(Pattern::grid(16).step(), 0.125F);
}

TEST(PatternGrid, SizeForFindsTheNearestNumberOfPoints) {
    EXPECT_EQ(Pattern::grid_size_for(193), 16);
    EXPECT_EQ(Pattern::grid_size_for(793), 32);
    EXPECT_EQ(Pattern::grid_size_for(3205), 64);
    EXPECT_EQ(Pattern::grid_size_for(1), 4);
    EXPECT_EQ(Pattern::grid_size_for(1000000), 128);
    for (const int wanted : {40, 100, 500}) {
        const int found = Pattern::grid_size_for(wanted);
        const int error = std::abs(Pattern::grid(found).size() - wanted);
        for (int n = 4; n <= 40; ++n) {
            ASSERT_GE(std::abs(Pattern::grid(n).size() - wanted), error) << "n = " << n;
        }
    }
}

TEST(PatternGrid, StencilReproducesLinearFieldsInside) {
    for (const int n : {8, 9, 16, 32}) {
        const Pattern pattern = Pattern::grid(n);
        Random random(2);
        for (int trial = 0; trial < 500; ++trial) {
            const double radius = (1 - 2.5 * pattern.step()) * std::sqrt(random.uniform());
            const double angle = random.uniform(0, 6.283);
            const auto x = static_cast<float>(radius * std::cos(angle));
            const auto y = static_cast<float>(radius * std::sin(angle));
            const Pattern::Stencil stencil = pattern.stencil(x, y);
            float value = 0;
            for (int k = 0; k < 4; ++k) {
                const Eigen::Vector3f node = pattern.point(stencil.node[k]);
                value += stencil.weight[k] * (2 + 3 * node.x() - 5 * node.y());
            }
            ASSERT_NEAR(value, 2 + 3 * x - 5 * y, 1e-4) << "n = " << n;
        }
    }
}

TEST(PatternGrid, StencilAtANodeIsThatNode) {
    const Pattern pattern = Pattern::grid(16);
    for (int i = 0; i < pattern.size(); ++i) {
        const Pattern::Stencil stencil =
            pattern.stencil(pattern.point(i).x(), pattern.point(i).y());
        float own = 0;
        for (int k = 0; k < 4; ++k) own += stencil.node[k] == i ? stencil.weight[k] : 0;
        ASSERT_NEAR(own, 1, 1e-5) << "node " << i;
    }
}

TEST(PatternRandomDisk, IsUniformByArea) {
    const Pattern pattern = Pattern::random_disk(8000, 3);
    int inner = 0;
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (int i = 0; i < pattern.size(); ++i) {
        inner += pattern.point(i).norm() < 0.5F;
        mean += pattern.point(i) / 8000;
    }
    EXPECT_NEAR(inner, 2000, 160);
    EXPECT_LT(mean.norm(), 0.03F);
}

TEST(PatternRandomDisk, DependsOnTheSeedAlone) {
    const Pattern first = Pattern::random_disk(50, 7);
    const Pattern same = Pattern::random_disk(50, 7);
    const Pattern other = Pattern::random_disk(50, 8);
    EXPECT_TRUE(std::equal(first.channel(0), first.channel(0) + 50, same.channel(0)));
    EXPECT_FALSE(std::equal(first.channel(0), first.channel(0) + 50, other.channel(0)));
}

TEST(PatternRandomDisk, StencilUsesNodesAround) {
    const Pattern pattern = Pattern::random_disk(400, 5);
    Random random(6);
    for (int trial = 0; trial < 300; ++trial) {
        const auto x = static_cast<float>(random.uniform(-0.6, 0.6));
        const auto y = static_cast<float>(random.uniform(-0.6, 0.6));
        for (const int node : pattern.stencil(x, y).node) {
            const Eigen::Vector3f p = pattern.point(node);
            ASSERT_LT(std::hypot(p.x() - x, p.y() - y), 6 * pattern.step());
        }
    }
}

TEST(PatternFromPoints, KeepsThePointsAndTheirHeights) {
    const Eigen::Matrix3Xf offsets = cross_offsets();
    const Pattern pattern = Pattern::from_points(offsets);
    ASSERT_EQ(pattern.size(), 5);
    EXPECT_EQ(pattern.grid_size(), 0);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(pattern.point(i), offsets.col(i));
}

TEST(PatternErrors, NameTheFieldAtFault) {
    expect_invalid([] { Pattern::grid(3); });
    expect_invalid([] { Pattern::grid(129); });
    expect_invalid([] { Pattern::random_disk(4, 1); });
    expect_invalid([] { Pattern::random_disk(1000000, 1); });
    expect_invalid([] { Pattern::from_points(Eigen::Matrix3Xf::Zero(3, 4)); });
    Eigen::Matrix3Xf offsets = cross_offsets();
    offsets(0, 1) = 1.1F;
    expect_invalid([&] { Pattern::from_points(offsets); });
    offsets(0, 1) = std::numeric_limits<float>::quiet_NaN();
    expect_invalid([&] { Pattern::from_points(offsets); });
}

TEST(PatternGrid, SizeForPointsIsTheNearestAndTheSmallerOnATie) {
    for (int n = 4; n <= 40; ++n) {
        const int points = Pattern::grid(n).size();
        const int next = Pattern::grid(n + 1).size();
        if (points == next || Pattern::grid_size_for(points) != n) continue;  // of equal ones
        const int middle = (points + next) / 2;
        EXPECT_EQ(Pattern::grid_size_for(middle), n) << points << " and " << next;
        EXPECT_EQ(Pattern::grid_size_for(middle + 1), n + 1) << points << " and " << next;
    }
}

}  // namespace
}  // namespace lpf
