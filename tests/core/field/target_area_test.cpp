#include "core/field/target_area.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/random.h"
#include "tests/core/clouds.h"

namespace lpf {
namespace {

Frame frame_at(const Eigen::Vector3d& centre, double radius) {
    return {.centre = centre, .radius = radius};
}

TEST(FrameTransforms, AreInverse) {
    Frame frame = frame_at({1e6, -2e6, 3.5}, 0.25);
    frame.axes =
        Eigen::AngleAxisf(0.8F, Eigen::Vector3f(1, -2, 0.5F).normalized()).toRotationMatrix();
    frame.origin = {0.1F, -0.2F, 0.3F};
    const Eigen::Vector3f local(0.4F, 0.5F, -0.6F);
    EXPECT_LT((frame.to_local(frame.to_world(local)) - local).norm(), 1e-5F);
    EXPECT_LT((frame.to_world(Eigen::Vector3f::Zero()) - frame.seed()).norm(), 1e-9);
    EXPECT_NEAR((frame.to_world(local) - frame.seed()).norm(), 0.25 * local.norm(), 1e-6);
}

class PointGridOn : public testing::TestWithParam<test::NamedCloud> {
protected:
    const Points& points = GetParam().points;

    [[nodiscard]] std::vector<Eigen::Vector3d> centres() const {
        std::vector<Eigen::Vector3d> centres = {Eigen::Vector3d(0.4, 0.5, 0.6),
                                                Eigen::Vector3d(-300, 0, 1e8)};
        Random random(3);
        const auto n = static_cast<std::uint64_t>(points.cols());
        for (int i = 0; n > 0 && i < 12; ++i) {
            centres.emplace_back(points.col(static_cast<Eigen::Index>(random.below(n))));
        }
        return centres;
    }
};

TEST_P(PointGridOn, SortsButLosesNoPoint) {
    const PointGrid grid(points, 0.3);
    ASSERT_EQ(grid.size(), static_cast<std::size_t>(points.cols()));
    std::vector<std::uint32_t> order = grid.order();
    for (std::size_t i = 0; i < order.size(); ++i) {
        ASSERT_LT((grid.point(i) - points.col(order[i])).norm(), 1e-8);
    }
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

TEST_P(PointGridOn, GathersTheBallThatBruteForceFinds) {
    constexpr float kReach = 1.1F;
    for (const double cell : {0.05, 0.3, 40.0}) {
        const PointGrid grid(points, cell);
        for (const double radius : {0.08, 0.35, 2.0}) {
            for (const Eigen::Vector3d& centre : centres()) {
                TargetArea target;
                grid.gather(centre, radius, kReach, target);
                std::map<std::uint32_t, Eigen::Vector3f> found;
                for (std::size_t i = 0; i < target.size; ++i) {
                    const std::uint32_t index = grid.order()[target.index[i]];
                    ASSERT_TRUE(
                        found.emplace(index, Eigen::Vector3f(target.x[i], target.y[i], target.z[i]))
                            .second)
                        << "gathered twice";
                }
                for (std::uint32_t i = 0; i < points.cols(); ++i) {
                    const Eigen::Vector3d exact = (points.col(i) - centre) / radius;
                    if (exact.norm() < kReach - 1e-5) {
                        ASSERT_TRUE(found.contains(i));
                    }
                    if (exact.norm() > kReach + 1e-5) {
                        ASSERT_FALSE(found.contains(i));
                    }
                    if (!found.contains(i)) continue;
                    ASSERT_LT((found[i] - exact.cast<float>()).norm(), 1e-5F);
                }
            }
        }
    }
}

TEST_P(PointGridOn, GathersInTheSameOrderEachTime) {
    if (points.cols() == 0) return;
    const PointGrid grid(points, 0.2);
    TargetArea first;
    TargetArea second;
    second.reserve(1000);
    grid.gather(points.col(0), 0.5, 1.1F, first);
    grid.gather(points.col(0), 2.0, 1.1F, second);  // a used buffer
    grid.gather(points.col(0), 0.5, 1.1F, second);
    ASSERT_EQ(first.size, second.size);
    EXPECT_GE(first.size, 1U);
    EXPECT_TRUE(std::equal(first.index.begin(), first.index.begin() + std::ptrdiff_t(first.size),
                           second.index.begin()));
}

TEST(NearPoints, AppendAddsSomeOfOthers) {
    NearPoints others;
    others.reserve(3);
    others.size = 3;
    for (std::size_t i = 0; i < 3; ++i) {
        others.x[i] = static_cast<float>(i);
        others.y[i] = 10 + others.x[i];
        others.z[i] = 20 + others.x[i];
        others.index[i] = static_cast<std::uint32_t>(i);
    }
    NearPoints points;
    points.append(others, 1, 2);
    points.append(others, 0, 1);
    ASSERT_EQ(points.size, 3U);
    const std::uint32_t order[] = {1, 2, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = static_cast<float>(order[i]);
        EXPECT_EQ(points.x[i], value);
        EXPECT_EQ(points.y[i], 10 + value);
        EXPECT_EQ(points.z[i], 20 + value);
        EXPECT_EQ(points.index[i], order[i]);
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, PointGridOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(PointGrid, BallsThatReachAFarPointDoNotWalkThroughTheEmptySpaceBetween) {
    Points points(3, 3);
    points << 0, 1, 1e30, 0, 1, -1e30, 0, 1, 1e30;
    const PointGrid grid(points, 1.0);
    NearPoints near;
    for (int i = 0; i < 100'000; ++i) {  // hours, if each met all the empty slabs of cells
        grid.gather(points.col(0), 1e30, 2.0F, near);
        ASSERT_EQ(near.size, 3U);
    }
}

TEST(TargetArea, ToFrameAgreesWithTheFramesOwnTransform) {
    const Points points = test::random_box(200, 1);
    Frame frame = frame_at({0.5, 0.4, 0.6}, 0.4);
    frame.axes = Eigen::AngleAxisf(1.3F, Eigen::Vector3f(3, 1, -2).normalized()).toRotationMatrix();
    frame.origin = {-0.2F, 0.1F, 0.05F};
    const PointGrid grid(points, 0.2);
    TargetArea target;
    grid.gather(frame.centre, frame.radius, 1.1F, target);
    ASSERT_GT(target.size, 20U);
    target.to_frame(frame);
    for (std::size_t i = 0; i < target.size; ++i) {
        const Eigen::Vector3f local(target.x[i], target.y[i], target.z[i]);
        ASSERT_LT((local - frame.to_local(grid.point(target.index[i]))).norm(), 1e-5F);
    }
}

TEST(TargetArea, KeepsDetailAtMapCoordinates) {
    Points points = test::random_box(300, 2);
    const Eigen::Vector3d offset(3.5e7, 5.6e6, 120);
    const PointGrid near(points, 0.2);
    const PointGrid far(points.colwise() + offset, 0.2);
    TargetArea a;
    TargetArea b;
    near.gather(points.col(5), 0.3, 1.1F, a);
    far.gather(points.col(5) + offset, 0.3, 1.1F, b);
    ASSERT_EQ(a.size, b.size);
    std::map<std::uint32_t, float> x;
    for (std::size_t i = 0; i < a.size; ++i) x[near.order()[a.index[i]]] = a.x[i];
    for (std::size_t i = 0; i < b.size; ++i) {
        EXPECT_NEAR(b.x[i], x.at(far.order()[b.index[i]]), 1e-6);
    }
}

}  // namespace
}  // namespace lpf
