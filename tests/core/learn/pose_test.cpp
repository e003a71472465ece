#include "core/learn/pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace lpf {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3f;
using Eigen::Vector3f;

/// The rotation that maximises tr(R S), by singular values.
Matrix3d svd_rotation(const Matrix3d& s) {
    const Eigen::JacobiSVD<Matrix3d> svd(s, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Matrix3d flip = Matrix3d::Identity();
    flip(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
    return svd.matrixV() * flip * svd.matrixU().transpose();
}

Matrix3d random_matrix(Random& random) {
    Matrix3d s;
    for (double& value : s.reshaped()) value = random.normal();
    return s;
}

Matrix3f random_turn(Random& random, double angle) {
    Vector3f axis;
    for (float& value : axis) value = static_cast<float>(random.normal());
    return Eigen::AngleAxisf(static_cast<float>(angle), axis.normalized()).toRotationMatrix();
}

std::vector<float> random_field(const Pattern& pattern, Random& random, double size) {
    std::vector<float> field(3 * static_cast<std::size_t>(pattern.padded_size()), 0.0F);
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < pattern.size(); ++i) {
            field[static_cast<std::size_t>(c * pattern.padded_size() + i)] =
                static_cast<float>(size * random.normal());
        }
    }
    return field;
}

Vector3f at(const Pattern& pattern, const std::vector<float>& field, int i) {
    const float* v = field.data() + i;
    return {v[0], v[pattern.padded_size()], v[2 * pattern.padded_size()]};
}

/// Eq. 4: sum |R (u + v) + t - (u + w)|^2.
double misfit(const Pattern& pattern, const std::vector<float>& v, const std::vector<float>& w,
              const RigidFit& fit) {
    double sum = 0;
    for (int i = 0; i < pattern.size(); ++i) {
        const Vector3f u = pattern.point(i);
        const Vector3f moved = fit.rotation * (u + at(pattern, v, i)) + fit.translation;
        sum += (moved - u - at(pattern, w, i)).squaredNorm();
    }
    return sum;
}

TEST(BestRotation, AgreesWithSingularValues) {
    Random random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        const Matrix3d s = random_matrix(random) * std::pow(10, random.uniform(-6, 6));
        const Matrix3d expected = svd_rotation(s);
        const Matrix3d found = best_rotation(s).cast<double>();
        ASSERT_NEAR((found * s).trace() / s.norm(), (expected * s).trace() / s.norm(), 1e-5);
        ASSERT_NEAR(found.determinant(), 1, 1e-4);
    }
}

TEST(BestRotation, OfASymmetricPositiveMatrixIsTheIdentity) {
    Random random(2);
    for (int trial = 0; trial < 100; ++trial) {
        const Matrix3d a = random_matrix(random);
        const Matrix3d s = a * a.transpose() + 0.1 * Matrix3d::Identity();
        ASSERT_LT((best_rotation(s) - Matrix3f::Identity()).norm(), 1e-3F);
    }
}

TEST(BestRotation, FindsTurnsOfAnyAngle) {
    Random random(3);
    for (const double angle : {0.0, 1e-4, 0.3, 1.5, 3.0, 3.14159}) {
        for (int trial = 0; trial < 20; ++trial) {
            const Matrix3f turn = random_turn(random, angle);
            const Matrix3d a = random_matrix(random);
            const Matrix3d spread = a * a.transpose() + 0.3 * Matrix3d::Identity();
            // b = turn a, so S = sum a b' = spread turn'.
            const Matrix3f found = best_rotation(spread * turn.transpose().cast<double>());
            ASSERT_LT((found - turn).norm(), 2e-3F) << "angle " << angle;
        }
    }
}

TEST(BestRotation, StaysARotationWhereTheMatrixLeavesItOpen) {
    EXPECT_EQ(best_rotation(Matrix3d::Zero()), Matrix3f::Identity());
    Matrix3d line = Matrix3d::Zero();
    line(0, 0) = 1;
    for (const Matrix3d& s : {line, Matrix3d(-Matrix3d::Identity()), Matrix3d(1e-200 * line),
                              Matrix3d(Matrix3d::Constant(std::nan("")))}) {
        const Matrix3f r = best_rotation(s);
        ASSERT_TRUE(r.allFinite());
        ASSERT_NEAR(r.determinant(), 1, 1e-4);
    }
}

class PoseFitOn : public testing::TestWithParam<int> {
protected:
    const Pattern pattern = GetParam() > 0 ? Pattern::grid(GetParam())
                                           : Pattern::random_disk(60, 1);
    Random random{7};
};

TEST_P(PoseFitOn, NeverRaisesTheMisfit) {
    for (int trial = 0; trial < 50; ++trial) {
        const auto v = random_field(pattern, random, 0.5);
        const auto w = random_field(pattern, random, 0.5);
        const RigidFit fit = fit_pose(pattern, v.data(), w.data());
        const double before = misfit(pattern, v, w, {});
        ASSERT_LE(misfit(pattern, v, w, fit), before * (1 + 1e-4));
        ASSERT_NEAR(fit.rotation.determinant(), 1, 1e-4);
    }
}

TEST_P(PoseFitOn, FindsTheRigidMotionBetweenTwoFields) {
    for (int trial = 0; trial < 20; ++trial) {
        const auto v = random_field(pattern, random, 0.2);
        RigidFit motion;
        motion.rotation = random_turn(random, 0.6);
        motion.translation = {0.1F, -0.3F, 0.2F};
        auto w = v;
        move_field(pattern, motion, w.data());
        const RigidFit fit = fit_pose(pattern, v.data(), w.data());
        // The regularisation pulls a little towards the identity.
        ASSERT_LT((fit.rotation - motion.rotation).norm(), 0.03F);
        ASSERT_LT(misfit(pattern, v, w, fit), 0.002 * misfit(pattern, v, w, {}));
    }
}

TEST_P(PoseFitOn, IsNoWorseThanAnyRigidMotionNearby) {
    const auto v = random_field(pattern, random, 0.3);
    const auto w = random_field(pattern, random, 0.1);
    const RigidFit fit = fit_pose(pattern, v.data(), w.data());
    const double best = misfit(pattern, v, w, fit);
    for (int trial = 0; trial < 200; ++trial) {
        RigidFit other = fit;
        other.rotation = random_turn(random, random.uniform(0.05, 0.5)) * fit.rotation;
        other.translation += 0.05F * Vector3f(static_cast<float>(random.normal()),
                                              static_cast<float>(random.normal()), 0);
        ASSERT_GE(misfit(pattern, v, w, other), best * 0.999);
    }
}

TEST_P(PoseFitOn, KeepsEveryProbedPointInItsPlace) {
    // The invariant that the literal Eq. 6 breaks: s + F (u + v) does not move.
    for (int trial = 0; trial < 20; ++trial) {
        auto v = random_field(pattern, random, 0.3);
        Frame frame{.centre = {100, 200, -50}, .radius = 0.7};
        frame.axes = random_turn(random, 2);
        frame.origin = {0.1F, 0.2F, 0.3F};
        std::vector<Eigen::Vector3d> before;
        for (int i = 0; i < pattern.size(); ++i) {
            before.push_back(frame.to_world(pattern.point(i) + at(pattern, v, i)));
        }
        RigidFit fit;
        fit.rotation = random_turn(random, random.uniform(0, 3));
        fit.translation = {0.5F, -0.4F, 0.3F};
        apply_pose(fit, frame);
        move_field(pattern, fit, v.data());
        for (int i = 0; i < pattern.size(); ++i) {
            const auto after = frame.to_world(pattern.point(i) + at(pattern, v, i));
            ASSERT_LT((after - before[static_cast<std::size_t>(i)]).norm(), 1e-5);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Patterns, PoseFitOn, testing::Values(0, 4, 16), [](const auto& test) {
    return test.param ? "Grid" + std::to_string(test.param) : std::string("Random");
});

TEST(ApplyPose, LeavesTheFrameARotationAfterManyUpdates) {
    Random random(9);
    Frame frame;
    for (int i = 0; i < 5000; ++i) {
        RigidFit fit;
        fit.rotation = random_turn(random, 0.5);
        apply_pose(fit, frame);
    }
    EXPECT_LT((frame.axes.transpose() * frame.axes - Matrix3f::Identity()).norm(), 1e-5F);
    EXPECT_NEAR(frame.axes.determinant(), 1, 1e-5);
}

TEST(FitPose, DoesNotTurnWhereAllProbedPointsAreOne) {
    const Pattern pattern = Pattern::grid(8);
    std::vector<float> v(3 * static_cast<std::size_t>(pattern.padded_size()), 0.0F);
    const std::vector<float> zero = v;
    for (int i = 0; i < pattern.size(); ++i) {
        const Vector3f to_point = Vector3f(0.1F, 0.2F, 0.3F) - pattern.point(i);
        for (int c = 0; c < 3; ++c) {
            v[static_cast<std::size_t>(c * pattern.padded_size() + i)] = to_point[c];
        }
    }
    const RigidFit fit = fit_pose(pattern, v.data(), zero.data());
    EXPECT_LT((fit.rotation - Matrix3f::Identity()).norm(), 1e-3F);
    EXPECT_LT((fit.translation + Vector3f(0.1F, 0.2F, 0.3F)).norm(), 1e-3F);
}

TEST(FitPose, IsTheIdentityBetweenEqualFields) {
    const Pattern pattern = Pattern::grid(16);
    Random random(10);
    const auto v = random_field(pattern, random, 0.2);
    const RigidFit fit = fit_pose(pattern, v.data(), v.data());
    EXPECT_LT((fit.rotation - Matrix3f::Identity()).norm(), 1e-3F);
    EXPECT_LT(fit.translation.norm(), 1e-3F);
}

TEST(BestRotation, OfAPositiveDefiniteMatrixIsTheIdentity) {
    Random random(11);
    for (int i = 0; i < 50; ++i) {
        Eigen::Matrix3d root;
        for (double& value : root.reshaped()) value = random.normal();
        const Eigen::Matrix3d s = root * root.transpose() + 0.1 * Eigen::Matrix3d::Identity();
        EXPECT_LT((best_rotation(s) - Eigen::Matrix3f::Identity()).norm(), 1e-5F);
    }
}

TEST(BestRotation, OfALineTurnsItOntoTheOther) {
    Random random(12);
    for (int i = 0; i < 50; ++i) {
        const Eigen::Vector3d a(random.normal(), random.normal(), random.normal());
        const Eigen::Vector3d b(random.normal(), random.normal(), random.normal());
        const Eigen::Matrix3d r = best_rotation(a * b.transpose()).cast<double>();
        EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-5);
        EXPECT_GT((r * a.normalized()).dot(b.normalized()), 0.999);
    }
}

TEST(ApplyPose, MakesAWornFrameARotationAgain) {
    Frame frame;
    frame.axes << 1.01F, 0.02F, 0, -0.01F, 0.98F, 0.03F, 0.01F, 0, 1.02F;
    apply_pose({}, frame);
    EXPECT_LT((frame.axes.transpose() * frame.axes - Eigen::Matrix3f::Identity()).norm(), 1e-5F);
    EXPECT_NEAR(frame.axes.determinant(), 1, 1e-5F);
}

}  // namespace
}  // namespace lpf
