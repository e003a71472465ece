#include "core/field/local_probing_field.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "tests/core/clouds.h"
#include "tests/core/field/targets.h"

namespace lpf {
namespace {

using Eigen::Matrix3f;
using Eigen::Matrix3Xf;
using Eigen::Vector3f;

void expect_rotation(const Matrix3f& axes) {
    ASSERT_TRUE(axes.allFinite());
    ASSERT_LT((axes.transpose() * axes - Matrix3f::Identity()).norm(), 1e-4F);
    ASSERT_NEAR(axes.determinant(), 1, 1e-4);
}

/// Points of the unit ball on a curve or surface, with noise of .02.
template <typename Shape>
Matrix3Xf noisy(std::uint64_t seed, const Shape& shape) {
    Random random(seed);
    Matrix3Xf points(3, 400);
    for (Eigen::Index i = 0; i < points.cols();) {
        const Vector3f p = shape(static_cast<float>(random.uniform(-1, 1)),
                                 static_cast<float>(random.uniform(-1, 1)));
        if (p.norm() > 1) continue;
        for (int c = 0; c < 3; ++c) {
            points(c, i) = p[c] + static_cast<float>(0.02 * random.normal());
        }
        ++i;
    }
    return points;
}

Dimension dimension_of(const Matrix3Xf& points) {
    return local_dimension(principal_directions(test::target_of(points)),
                           static_cast<std::size_t>(points.cols()));
}

TEST(PrincipalDirections, AgreeWithAnEigenDecomposition) {
    Matrix3Xf points = test::random_box(500, 1, -1, 1).cast<float>();
    points.row(1) *= 0.5F;
    points.row(2) *= 0.2F;
    const Matrix3f turn = Eigen::AngleAxisf(0.9F, Vector3f(1, 2, 2) / 3).toRotationMatrix();
    points = (turn * points).eval();
    const PrincipalDirections principal = principal_directions(test::target_of(points));
    const Vector3f mean = points.rowwise().mean();
    const Matrix3Xf centred = points.colwise() - mean;
    const Matrix3f covariance = centred * centred.transpose() / 500;
    const Eigen::SelfAdjointEigenSolver<Matrix3f> solver(covariance);
    EXPECT_LT((principal.mean - mean).norm(), 1e-5F);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(principal.variances[i], solver.eigenvalues()[2 - i], 1e-5);
        EXPECT_NEAR(std::abs(principal.axes.col(i).dot(solver.eigenvectors().col(2 - i))), 1, 1e-3);
    }
    expect_rotation(principal.axes);
}

class PrincipalDirectionsOn : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(PrincipalDirectionsOn, AreAlwaysARotation) {
    Points points = GetParam().points;
    if (points.cols() == 0) return;
    points.colwise() -= points.col(0).eval();  // as a target area is: small, near its centre
    points /= 1 + points.cwiseAbs().maxCoeff();
    for (const double scale : {1.0, 1e-3, 1e-6}) {
        const Matrix3Xf local = (scale * points).cast<float>();
        const PrincipalDirections principal = principal_directions(test::target_of(local));
        expect_rotation(principal.axes);
        ASSERT_TRUE(principal.variances.allFinite());
        ASSERT_GE(principal.variances.minCoeff(), 0);
        Frame frame;
        align_with_principal_directions(principal, frame);
        expect_rotation(frame.axes);
        ASSERT_TRUE(frame.origin.allFinite());
    }
}

INSTANTIATE_TEST_SUITE_P(Clouds, PrincipalDirectionsOn, testing::ValuesIn(test::awkward_clouds()),
                         test::CloudName());

TEST(LocalDimension, OfALineIsACurve) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const auto line = [](float s, float) { return Vector3f(0.6F * s, 0, 0.8F * s); };
        EXPECT_EQ(dimension_of(noisy(seed, line)), kCurve);
    }
}

TEST(LocalDimension, OfPlaneBorderEdgeAndCornerIsASurface) {
    const auto plane = [](float s, float t) { return Vector3f(s, t, 0); };
    const auto border = [](float s, float t) { return Vector3f(s, std::abs(t), 0); };
    const auto edge = [](float s, float t) {
        return Vector3f(s, std::max(t, 0.0F), std::min(t, 0.0F));
    };
    const auto corner = [](float s, float t) { return Vector3f(std::abs(s), std::abs(t), 0); };
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        EXPECT_EQ(dimension_of(noisy(seed, plane)), kSurface);
        EXPECT_EQ(dimension_of(noisy(seed, border)), kSurface);
        EXPECT_EQ(dimension_of(noisy(seed, edge)), kSurface);
        EXPECT_EQ(dimension_of(noisy(seed, corner)), kSurface);
    }
}

TEST(LocalDimension, OfAFewPointsIsUnknown) {
    const Matrix3Xf points = test::random_box(kFewestTargetPoints, 4).cast<float>();
    EXPECT_EQ(dimension_of(points.leftCols(kFewestTargetPoints - 1)), kTooFewPoints);
    EXPECT_NE(dimension_of(points), kTooFewPoints);
}

TEST(LocalDimension, LooksAtTheSpreadAboveThatOfTheNoise) {
    const auto of = [](float l1, float l2, float l3) {
        return local_dimension({.mean = {}, .variances = {l1, l2, l3}, .axes = {}}, 100);
    };
    // A thick line: the same spread across it in both directions.
    EXPECT_EQ(of(0.3F, 0.1F, 0.1F), kCurve);
    EXPECT_EQ(of(0.3F, 0.1F, 0.0F), kSurface);
    EXPECT_EQ(of(1.1F, 0.1F + 0.18F, 0.1F), kCurve);
    EXPECT_EQ(of(1.1F, 0.1F + 0.20F, 0.1F), kSurface);
}

TEST(FrameOfAField, HasItsSeedAtTheOriginOfItsCoordinates) {
    Frame frame;
    frame.centre << 10, -20, 30;
    frame.radius = 0.25;
    frame.origin << 0.4F, -0.8F, 0.2F;
    frame.axes = Eigen::AngleAxisf(0.7F, Vector3f(1, 2, 3).normalized()).toRotationMatrix();
    EXPECT_LT((frame.seed() - Eigen::Vector3d(10.1, -20.2, 30.05)).norm(), 1e-6);
    EXPECT_LT((frame.seed() - frame.to_world(Vector3f::Zero())).norm(), 1e-6);
    const Vector3f p(0.3F, 0.5F, -0.6F);
    EXPECT_LT((frame.to_local(frame.to_world(p)) - p).norm(), 1e-5F);
}

TEST(FirstPose, LiesOnTheMeanPlaneBelowTheCentre) {
    Matrix3Xf points = noisy(3, [](float s, float t) { return Vector3f(s, t, 0); });
    const Matrix3f turn = Eigen::AngleAxisf(0.5F, Vector3f::UnitX()).toRotationMatrix();
    points = (turn * points).eval().colwise() + 0.3F * turn.col(2);
    Frame frame;
    align_with_principal_directions(principal_directions(test::target_of(points)), frame);
    EXPECT_GT(std::abs(frame.axes.col(2).dot(turn.col(2))), 0.999F);
    EXPECT_LT((frame.origin - 0.3F * turn.col(2)).norm(), 0.02F);
    EXPECT_LT(frame.origin.cross(frame.axes.col(2)).norm(), 1e-5F);
}

TEST(RandomFrames, AreRotationsWithoutPreference) {
    Matrix3f mean = Matrix3f::Zero();
    Random random(5);
    for (int i = 0; i < 3000; ++i) {
        Frame frame;
        frame.origin = Vector3f::Ones();
        rotate_randomly(random, frame);
        expect_rotation(frame.axes);
        ASSERT_EQ(frame.origin, Vector3f::Zero());
        mean += frame.axes / 3000;
    }
    EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.04F);
}

}  // namespace
}  // namespace lpf
