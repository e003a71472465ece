#include "core/field/probing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "core/base/random.h"
#include "tests/core/clouds.h"
#include "tests/core/field/targets.h"
#include "tests/support/meshes.h"
#include "tests/support/metrics.h"

namespace lpf {
namespace {

using Eigen::Matrix3Xf;
using Eigen::Vector3f;

/// The points u_i + v_i that an operator finds.
Matrix3Xf probed(const ProbingOperator& probing, const Pattern& pattern, const Matrix3Xf& points,
                 bool curve = false) {
    ProbeScratch scratch;
    scratch.target = test::target_of(points);
    std::vector<float> v(3 * static_cast<std::size_t>(pattern.padded_size()), 99.0F);
    probing.probe({}, curve, scratch, v.data());
    Matrix3Xf result(3, pattern.size());
    for (int c = 0; c < 3; ++c) {
        for (int i = 0; i < pattern.padded_size(); ++i) {
            const float value = v[static_cast<std::size_t>(c * pattern.padded_size() + i)];
            EXPECT_TRUE(std::isfinite(value));
            if (i < pattern.size()) {
                result(c, i) = pattern.channel(c)[i] + value;
            } else {
                EXPECT_EQ(value, 0) << "padding";
            }
        }
    }
    return result;
}

/// Least value of `distance` over the points, and whether `found` is one of those points.
void expect_nearest(const Matrix3Xf& points, const Vector3f& found,
                    const std::function<float(const Vector3f&)>& distance) {
    float least = std::numeric_limits<float>::infinity();
    bool member = false;
    for (const Vector3f& point : points.colwise()) {
        least = std::min(least, distance(point));
        member |= (point - found).norm() < 1e-5F;
    }
    ASSERT_TRUE(member) << found.transpose() << " is no point of the target";
    ASSERT_NEAR(distance(found), least, 1e-5);
}

struct NamedTarget {
    std::string name;
    Matrix3Xf points;
};

void PrintTo(const NamedTarget& target, std::ostream* out) { *out << target.name; }

std::vector<NamedTarget> targets() {
    const Matrix3Xf ball = test::random_box(300, 1, -0.8, 0.8).cast<float>();
    Matrix3Xf line = ball;
    line.bottomRows(2).setZero();
    Matrix3Xf upright = ball;
    upright.topRows(2).setZero();
    Matrix3Xf corner = ball * 0.1F;
    corner.colwise() += Vector3f(0.9F, -0.5F, 0.2F);
    return {{"Box", ball},
            {"Sparse", ball.leftCols(4)},
            {"OnePoint", ball.leftCols(1)},
            {"Line", line},
            {"Upright", upright},
            {"AllEqual", ball.leftCols(1).replicate(1, 50)},
            {"FarCorner", corner},
            {"Tiny", ball * 1e-6F}};
}

class ProbingOn : public testing::TestWithParam<NamedTarget> {
protected:
    const Matrix3Xf& points = GetParam().points;
    const std::vector<Pattern> patterns = {Pattern::grid(4), Pattern::grid(16),
                                           Pattern::random_disk(150, 3)};
};

TEST_P(ProbingOn, OrthogonalFindsTheNearestPointInThePlane) {
    for (const Pattern& pattern : patterns) {
        const Matrix3Xf found = probed(*make_orthogonal_probing(pattern), pattern, points);
        for (int i = 0; i < pattern.size(); ++i) {
            expect_nearest(points, found.col(i), [&](const Vector3f& p) {
                return (p - pattern.point(i)).head<2>().norm();
            });
        }
    }
}

TEST_P(ProbingOn, NearestPointFindsTheNearestPointInSpace) {
    for (const Pattern& pattern : patterns) {
        const Matrix3Xf found = probed(*make_nearest_point_probing(pattern), pattern, points);
        for (int i = 0; i < pattern.size(); ++i) {
            expect_nearest(points, found.col(i),
                           [&](const Vector3f& p) { return (p - pattern.point(i)).norm(); });
        }
    }
}

TEST_P(ProbingOn, NoiseAwareStaysFiniteAndBetweenTheTargetsHeights) {
    for (const Pattern& pattern : patterns) {
        for (const double width : {0.05, 0.125, 0.5}) {
            for (const bool curve : {false, true}) {
                const auto probing = make_noise_aware_probing(pattern, width);
                const Matrix3Xf found = probed(*probing, pattern, points, curve);
                const float slack = 1e-4F;
                // Zero is the answer where nothing is known.
                ASSERT_GE(found.row(2).minCoeff(),
                          std::min(0.0F, points.row(2).minCoeff()) - slack);
                ASSERT_LE(found.row(2).maxCoeff(),
                          std::max(0.0F, points.row(2).maxCoeff()) + slack);
            }
        }
    }
}

TEST_P(ProbingOn, OperatorsDependOnTheTargetAloneNotOnWhatWasProbedBefore) {
    const Pattern pattern = Pattern::grid(8);
    const Matrix3Xf other = test::random_box(700, 9, -1, 1).cast<float>();
    for (const auto& probing : {make_orthogonal_probing, make_nearest_point_probing}) {
        const auto op = probing(pattern);
        ProbeScratch scratch;
        std::vector<float> used(3 * static_cast<std::size_t>(pattern.padded_size()));
        std::vector<float> fresh(used.size());
        scratch.target = test::target_of(other);
        op->probe({}, false, scratch, used.data());
        scratch.target = test::target_of(points);
        op->probe({}, false, scratch, used.data());
        ProbeScratch clean;
        clean.target = test::target_of(points);
        op->probe({}, false, clean, fresh.data());
        EXPECT_EQ(used, fresh);
    }
}

INSTANTIATE_TEST_SUITE_P(Targets, ProbingOn, testing::ValuesIn(targets()),
                         [](const auto& test) { return test.param.name; });

TEST(Probing, OfAnEmptyTargetIsTheZeroField) {
    const Pattern pattern = Pattern::grid(8);
    for (const bool curve : {false, true}) {
        for (const auto& probing :
             {make_orthogonal_probing(pattern), make_nearest_point_probing(pattern),
              make_noise_aware_probing(pattern, 0.125)}) {
            const Matrix3Xf found = probed(*probing, pattern, Matrix3Xf(3, 0), curve);
            for (int i = 0; i < pattern.size(); ++i) {
                ASSERT_EQ(Vector3f(found.col(i)), pattern.point(i));
            }
        }
    }
}

/// A dense square of points at the heights that a function gives.
Matrix3Xf surface(const std::function<float(float, float)>& height, float from_x = -1.2F) {
    Matrix3Xf points = test::random_box(30000, 2, -1.2, 1.2).cast<float>();
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points(0, i) = std::max(points(0, i), from_x);
        points(2, i) = height(points(0, i), points(1, i));
    }
    return points;
}

class NoiseAware : public testing::TestWithParam<int> {
protected:
    const Pattern pattern = GetParam() ? Pattern::grid(GetParam()) : Pattern::random_disk(200, 4);
    const std::unique_ptr<ProbingOperator> probing = make_noise_aware_probing(pattern, 0.125);
};

TEST_P(NoiseAware, NodesKeepTheirPlaceInThePlaneAndMeetALevelSurface) {
    const Matrix3Xf found = probed(*probing, pattern, surface([](float, float) { return 0.3F; }));
    for (int i = 0; i < pattern.size(); ++i) {
        ASSERT_NEAR(found(2, i), 0.3, 1e-4);
        ASSERT_LT((found.col(i) - pattern.point(i)).head<2>().norm(), 1e-5F);
    }
}

TEST_P(NoiseAware, ReproducesASlope) {
    const Matrix3Xf found =
        probed(*probing, pattern, surface([](float x, float y) { return 0.2F * x - 0.1F * y; }));
    for (int i = 0; i < pattern.size(); ++i) {
        const Vector3f u = pattern.point(i);
        if (u.norm() > 0.75F) continue;
        ASSERT_NEAR(found(2, i), 0.2F * u.x() - 0.1F * u.y(), 0.03);
    }
}

TEST_P(NoiseAware, AveragesNoiseAway) {
    Random random(5);
    const Matrix3Xf noisy =
        surface([&](float, float) { return static_cast<float>(0.1 * random.normal()); });
    const Matrix3Xf found = probed(*probing, pattern, noisy);
    EXPECT_LT(std::sqrt(found.row(2).squaredNorm() / static_cast<float>(found.cols())), 0.01F);
}

TEST_P(NoiseAware, WeighsByAGaussian) {
    // One heap of points among a level surface: its share in a mean follows the kernel.
    Matrix3Xf points = surface([](float, float) { return 0.0F; });
    const auto heap = points.cols() / 10;
    const Vector3f place = pattern.point(pattern.by_distance()[0]);
    points.leftCols(heap).colwise() = Vector3f(place.x(), place.y(), 1.0F);
    const Matrix3Xf found = probed(*probing, pattern, points);
    const double background = 27000 / (2.4 * 2.4);  // points for each unit of area
    for (int i = 0; i < pattern.size(); ++i) {
        const double distance = (pattern.point(i) - place).head<2>().norm();
        if (distance > 0.3) continue;
        const double weight = 3000 * std::exp(-0.5 * std::pow(distance / 0.125, 2));
        const double level = background * 2 * 3.14159 * 0.125 * 0.125;
        ASSERT_NEAR(found(2, i), weight / (weight + level), 0.12) << "at distance " << distance;
    }
}

TEST_P(NoiseAware, PullsNodesBeyondABorderToItNotBeyond) {
    Matrix3Xf points = surface([](float, float) { return 0.1F; }, 0.0F);
    const Matrix3Xf half =
        points.rightCols(15000).array().max(Matrix3Xf::Constant(3, 15000, -9).array());
    Matrix3Xf kept(3, 0);
    for (Eigen::Index i = 0; i < half.cols(); ++i) {
        if (half(0, i) <= 0) continue;
        kept.conservativeResize(3, kept.cols() + 1);
        kept.rightCols(1) = half.col(i);
    }
    const Matrix3Xf found = probed(*probing, pattern, kept);
    EXPECT_GT(found.row(0).minCoeff(), -0.4F) << "pattern points stay far beyond the border";
    for (int i = 0; i < pattern.size(); ++i) ASSERT_NEAR(found(2, i), 0.1, 1e-4);
}

TEST_P(NoiseAware, OnACurveFindsTheMeanCrossSection) {
    Matrix3Xf line(3, 4000);
    Random random(6);
    for (Eigen::Index i = 0; i < line.cols(); ++i) {
        const auto x = static_cast<float>(random.uniform(-1.1, 1.1));
        line.col(i) = Vector3f(x, 0.2F * x + static_cast<float>(0.02 * random.normal()),
                               -0.1F + static_cast<float>(0.02 * random.normal()));
    }
    const Matrix3Xf found = probed(*probing, pattern, line, true);
    for (int i = 0; i < pattern.size(); ++i) {
        const float x = pattern.point(i).x();
        if (std::abs(x) > 0.75F) continue;
        ASSERT_NEAR(found(0, i), x, 1e-5) << "a node must not slide along the curve";
        ASSERT_NEAR(found(1, i), 0.2F * x, 0.03);
        ASSERT_NEAR(found(2, i), -0.1F, 0.02);
    }
}

INSTANTIATE_TEST_SUITE_P(Patterns, NoiseAware, testing::Values(0, 16, 32), [](const auto& test) {
    return test.param ? "Grid" + std::to_string(test.param) : std::string("Random");
});

TEST(MeshSamples, LieOnTheirTrianglesAndCoverThem) {
    const Shape mesh = test::cube_mesh(1.0, 2);
    const double spacing = 0.2;
    const MeshSamples samples = sample_mesh(mesh, spacing);
    ASSERT_EQ(samples.triangle.size(), static_cast<std::size_t>(samples.points.cols()));
    for (Eigen::Index i = 0; i < samples.points.cols(); ++i) {
        const auto corners = mesh.triangles.col(samples.triangle[static_cast<std::size_t>(i)]);
        ASSERT_LT(test::squared_distance_to_triangle(
                      samples.points.col(i), mesh.cloud.points.col(corners[0]),
                      mesh.cloud.points.col(corners[1]), mesh.cloud.points.col(corners[2])),
                  1e-20);
    }
    const test::CloudDistance to_samples(samples.points);
    for (Eigen::Index i = 0; i < mesh.cloud.points.cols(); ++i) {
        EXPECT_LT(to_samples(mesh.cloud.points.col(i)), spacing);
    }
}

TEST(MeshSamples, EveryTriangleHasOneHoweverSmall) {
    const Shape mesh = test::icosphere(1.0, 2);
    const MeshSamples samples = sample_mesh(mesh, 100);
    const std::set<std::uint32_t> seen(samples.triangle.begin(), samples.triangle.end());
    EXPECT_EQ(seen.size(), static_cast<std::size_t>(mesh.triangles.cols()));
}

/// A frame on a mesh, its target area, and what it probes, in world coordinates.
struct MeshProbe {
    MeshProbe(Shape shape, const Frame& at)
        : mesh(std::move(shape)),
          samples(sample_mesh(mesh, 0.1 * at.radius)),
          grid(samples.points, 0.5 * at.radius),
          frame(at) {
        ProbeScratch scratch;
        grid.gather(frame.centre, frame.radius, 1.1F, scratch.target);
        scratch.target.to_frame(frame);
        std::vector<float> v(3 * static_cast<std::size_t>(pattern.padded_size()));
        make_nearest_triangle_probing(pattern, mesh, samples, grid)
            ->probe(frame, false, scratch, v.data());
        for (int i = 0; i < pattern.size(); ++i) {
            displacements.emplace_back(v[static_cast<std::size_t>(i)],
                                       v[static_cast<std::size_t>(pattern.padded_size() + i)],
                                       v[static_cast<std::size_t>(2 * pattern.padded_size() + i)]);
            world.push_back(frame.to_world(pattern.point(i) + displacements.back()));
        }
    }

    Pattern pattern = Pattern::grid(16);
    Shape mesh;
    MeshSamples samples;
    PointGrid grid;
    Frame frame;
    std::vector<Vector3f> displacements;
    std::vector<Eigen::Vector3d> world;
};

TEST(NearestTriangle, MeetsATiltedPlaneAlongTheNormal) {
    Frame frame{.centre = {0.1, 0.2, 0.02}, .radius = 0.4};
    frame.axes = Eigen::AngleAxisf(0.2F, Vector3f::UnitY()).toRotationMatrix();
    const MeshProbe probe(test::plane_grid(2.0, 7), frame);
    for (std::size_t i = 0; i < probe.world.size(); ++i) {
        ASSERT_NEAR(probe.world[i].z(), 0, 1e-6);
        ASSERT_LT(probe.displacements[i].head<2>().norm(), 1e-5F);
    }
}

TEST(NearestTriangle, StaysOnTheMeshAtABorder) {
    const MeshProbe probe(test::plane_grid(1.0, 5), Frame{.centre = {1, 1, 0}, .radius = 0.5});
    for (const Eigen::Vector3d& point : probe.world) {
        ASSERT_LE(point.x(), 1 + 1e-6);
        ASSERT_LE(point.y(), 1 + 1e-6);
        ASSERT_NEAR(point.z(), 0, 1e-6);
    }
}

TEST(NearestTriangle, LiesOnACubesSurfaceAroundACorner) {
    Frame frame{.centre = {1, 1, 1}, .radius = 0.5};
    frame.axes =
        Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitZ(), Vector3f(1, 1, 1)).toRotationMatrix();
    const MeshProbe probe(test::cube_mesh(1.0, 3), frame);
    const test::MeshDistance distance(probe.mesh.cloud.points, probe.mesh.triangles);
    for (const Eigen::Vector3d& point : probe.world) ASSERT_LT(distance(point), 1e-5);
}

TEST(NearestTriangle, OfTwoSheetsTakesTheOneNearerToThePlane) {
    Shape mesh = test::plane_grid(1.0, 4);
    const Shape upper = test::plane_grid(1.0, 4);
    const Eigen::Index n = mesh.cloud.points.cols();
    const Eigen::Index f = mesh.triangles.cols();
    mesh.cloud.points.conservativeResize(3, 2 * n);
    mesh.cloud.points.rightCols(n) = upper.cloud.points.colwise() + Eigen::Vector3d(0, 0, 0.1);
    mesh.triangles.conservativeResize(3, 2 * f);
    mesh.triangles.rightCols(f) = upper.triangles.array() + static_cast<std::uint32_t>(n);
    for (const double z : {0.01, 0.04, 0.06, 0.09}) {
        const MeshProbe probe(mesh, Frame{.centre = {0, 0, z}, .radius = 0.4});
        for (const Eigen::Vector3d& point : probe.world) {
            ASSERT_NEAR(point.z(), z < 0.05 ? 0 : 0.1, 1e-6) << "from " << z;
        }
    }
}

}  // namespace
}  // namespace lpf
