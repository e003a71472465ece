#include "core/shape/normals.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "tests/core/clouds.h"
#include "tests/support/shapes.h"

namespace lpf {
namespace {

using Eigen::Vector3f;

TEST(Normals, OfASpherePointOutwards) {
    const Points points = test::make_sphere({.points = 4000}).points;
    const Eigen::Matrix3Xf normals = estimate_normals(points, 16, {});
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        ASSERT_GT(normals.col(i).dot(points.col(i).cast<float>()), 0.98F);
    }
}

TEST(Normals, OfATiltedPlaneAreItsNormal) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const Points points = turn * test::make_plane({.points = 1000}).points;
    const Eigen::Matrix3Xf normals = estimate_normals(points, 10, {});
    for (const auto& normal : normals.colwise()) {
        ASSERT_NEAR(std::abs(normal.dot(turn.col(2).cast<float>())), 1, 1e-5);
    }
}

TEST(Normals, OfAPlaneThroughItsOwnCentreAgreeOnASide) {
    const Eigen::Matrix3Xf normals =
        estimate_normals(test::make_plane({.points = 500}).points, 10, {});
    for (const auto& normal : normals.colwise()) ASSERT_NEAR(normal.z(), 1, 1e-6);
}

TEST(Normals, SurviveMapCoordinates) {
    Points points = test::make_sphere({.points = 2000}).points;
    const Eigen::Matrix3Xf near = estimate_normals(points, 12, {});
    points.colwise() += Eigen::Vector3d(1e7, -2e7, 5e6);
    EXPECT_LT((estimate_normals(points, 12, {}) - near).cwiseAbs().maxCoeff(), 1e-3F);
}

TEST(Normals, WithoutAPlanePointUp) {
    for (const auto& cloud : test::awkward_clouds()) {
        if (cloud.name != "AllEqual" && cloud.name != "Line" && cloud.name != "OnePoint") continue;
        const Eigen::Matrix3Xf normals = estimate_normals(cloud.points, 8, {});
        for (const auto& normal : normals.colwise()) {
            ASSERT_EQ(normal, Vector3f::UnitZ()) << cloud.name;
        }
    }
}

TEST(Normals, DoNotDependOnTheNumberOfThreads) {
    const Points points = test::make_sphere({.points = 9000, .noise = 0.01}).points;
    const Eigen::Matrix3Xf one = estimate_normals(points, 8, {.threads = 1});
    EXPECT_EQ(estimate_normals(points, 8, {.threads = 2}), one);
    EXPECT_EQ(estimate_normals(points, 8, {.threads = 8}), one);
}

TEST(Normals, StopWhenCancelled) {
    std::stop_source source;
    source.request_stop();
    const Execution execution{.stop = source.get_token()};
    EXPECT_THROW((void)estimate_normals(test::random_box(10, 1), 4, execution), Error);
}

class NormalsOn : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(NormalsOn, AreUnitVectors) {
    for (const int k : {1, 3, 12, 1000}) {
        const Eigen::Matrix3Xf normals = estimate_normals(GetParam().points, k, {});
        ASSERT_EQ(normals.cols(), GetParam().points.cols());
        for (const auto& normal : normals.colwise()) ASSERT_NEAR(normal.norm(), 1, 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, NormalsOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

}  // namespace
}  // namespace lpf
