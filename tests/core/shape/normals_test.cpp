#include "core/shape/normals.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "core/base/random.h"
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

/// `count` points in the plane through the origin across `normal`, the same on both sides of it.
Points flat_points(const Eigen::Vector3d& normal, Eigen::Index count, std::uint64_t seed) {
    Random random(seed);
    const Eigen::Vector3d a = normal.unitOrthogonal();
    const Eigen::Vector3d b = normal.cross(a);
    Points points(3, 2 * count);
    for (Eigen::Index i = 0; i < count; ++i) {
        points.col(i) = random.normal() * a + random.normal() * b;
        points.col(count + i) = -points.col(i);
    }
    return points;
}

TEST(Normals, OfAFlatSheetPointAlongTheirGreatestCoordinate) {
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(-0.3, 0.9, 0.2), Eigen::Vector3d(-0.3, -0.2, 0.9),
          Eigen::Vector3d(0.9, -0.4, -0.3), Eigen::Vector3d(-0.4, 0.8, -0.5)}) {
        const Eigen::Vector3d expected = direction.normalized();
        const Eigen::Matrix3Xf normals = estimate_normals(flat_points(expected, 100, 3), 8, {});
        for (const Eigen::Vector3f& normal : normals.colwise()) {
            ASSERT_GT(normal.dot(expected.cast<float>()), 0.999F);
        }
    }
}

TEST(Normals, TakeThreeNeighboursAtLeast) {
    const Eigen::Vector3d expected = Eigen::Vector3d(0.2, -0.3, 0.9).normalized();
    const Eigen::Matrix3Xf normals = estimate_normals(flat_points(expected, 50, 4), 1, {});
    for (const Eigen::Vector3f& normal : normals.colwise()) {
        ASSERT_GT(normal.dot(expected.cast<float>()), 0.999F);
    }
}

TEST(Normals, AreTheLeastPrincipalDirectionsOfTheNeighbours) {
    constexpr int kNeighbours = 9;
    const Points points = test::random_box(150, 6);
    const Eigen::Matrix3Xf normals = estimate_normals(points, kNeighbours, {});
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
        std::iota(order.begin(), order.end(), 0);
        std::ranges::sort(order, {}, [&](Eigen::Index k) {
            return (points.col(k) - points.col(i)).squaredNorm();
        });
        Points near(3, kNeighbours);
        for (int k = 0; k < kNeighbours; ++k) {
            near.col(k) = points.col(order[static_cast<std::size_t>(k)]);
        }
        near.colwise() -= near.rowwise().mean().eval();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(near * near.transpose());
        const Eigen::Vector3d expected = solver.eigenvectors().col(0);
        ASSERT_GT(std::abs(normals.col(i).cast<double>().dot(expected)), 0.999);
    }
}

}  // namespace
}  // namespace lpf
