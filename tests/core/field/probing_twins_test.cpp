// Probing operators against their definitions, written down without rasters or bins.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/random.h"
#include "core/field/probing.h"
#include "tests/core/field/targets.h"

namespace lpf {
namespace {

using Eigen::Matrix3Xf;
using Eigen::Vector3d;
using Eigen::Vector3f;

std::vector<Vector3f> probed(const ProbingOperator& probing, const Pattern& pattern,
                             const TargetArea& target, bool curve = false) {
    ProbeScratch scratch;
    scratch.target = target;
    const auto stride = static_cast<std::size_t>(pattern.padded_size());
    std::vector<float> v(3 * stride);
    Frame frame;
    frame.centre.setZero();
    probing.probe(frame, curve, scratch, v.data());
    std::vector<Vector3f> result;
    for (int i = 0; i < pattern.size(); ++i) {
        const auto k = static_cast<std::size_t>(i);
        result.push_back(pattern.point(i) + Vector3f(v[k], v[stride + k], v[2 * stride + k]));
    }
    return result;
}

/// Points over part of the disk, so that some nodes have full, some little and some no support.
Matrix3Xf partial_target(std::uint64_t seed, bool curve) {
    Random random(seed);
    Matrix3Xf points(3, 60);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const double x = random.uniform(-1.0, 0.3);
        const double y = curve ? 0.1 * random.normal() : random.uniform(-0.9, 0.5);
        points.col(i) << static_cast<float>(x), static_cast<float>(y),
            static_cast<float>(0.2 * x + 0.1 * random.normal());
    }
    return points;
}

/// What noise-aware probing is defined to give on a grid: Gaussian means over cells of one step.
class KernelTwin {
public:
    KernelTwin(const Pattern& pattern, double width, const Matrix3Xf& points, bool curve)
        : pattern_(pattern), width_(width), curve_(curve), points_(points) {
        double total = 0;
        for (int i = 0; i < pattern.size(); ++i) {
            sums_.push_back(sums_at(pattern.point(i)));
            total += sums_.back()[0];
        }
        least_ = std::max(0.3, 0.5 * total / pattern.size());
    }

    [[nodiscard]] Vector3d point(int node) const {
        const Vector3d u = pattern_.point(node).cast<double>();
        if (supported(node)) {
            const Vector3d mean = mean_at(node);
            return {u.x(), curve_ ? mean.y() : u.y(), mean.z()};
        }
        const int best = nearest_supported(u);
        return best < 0 ? u : mean_at(best);
    }

    [[nodiscard]] bool supported(int node) const { return sums(node)[0] >= least_; }

private:
    [[nodiscard]] int cell(float coordinate) const {
        return static_cast<int>(std::floor(coordinate / pattern_.step() + 0.5F));
    }

    [[nodiscard]] const Eigen::Vector4d& sums(int node) const {
        return sums_[static_cast<std::size_t>(node)];
    }

    [[nodiscard]] Vector3d mean_at(int node) const { return sums(node).tail<3>() / sums(node)[0]; }

    [[nodiscard]] double tap(int cells) const {
        const double step = static_cast<double>(pattern_.step());
        if (std::abs(cells) > std::ceil(3 * width_ / step)) return 0;
        return std::exp(-0.5 * std::pow(cells * step / width_, 2));
    }

    [[nodiscard]] Eigen::Vector4d sums_at(const Vector3f& u) const {
        Eigen::Vector4d sums = Eigen::Vector4d::Zero();
        for (const Vector3f& p : points_.colwise()) {
            const double weight =
                tap(cell(p.x()) - cell(u.x())) * (curve_ ? 1.0 : tap(cell(p.y()) - cell(u.y())));
            sums += weight * Eigen::Vector4d(1, p.x(), p.y(), p.z());
        }
        return sums;
    }

    [[nodiscard]] int nearest_supported(const Vector3d& u) const {
        int best = -1;
        double least = 1e30;
        for (int i = 0; i < pattern_.size(); ++i) {
            const Vector3d offset = pattern_.point(i).cast<double>() - u;
            const double squared = offset.x() * offset.x() + (curve_ ? 0 : offset.y() * offset.y());
            if (supported(i) && squared < least - 1e-9) best = i, least = squared;
        }
        return best;
    }

    const Pattern& pattern_;
    double width_;
    bool curve_;
    Matrix3Xf points_;
    std::vector<Eigen::Vector4d> sums_;
    double least_ = 0;
};

class NoiseAwareTwin : public testing::TestWithParam<bool> {};

TEST_P(NoiseAwareTwin, AgreesWithKernelMeans) {
    const Pattern pattern = Pattern::grid(16);  // a step that floats hold exactly, so ties are ties
    for (const double width : {0.08, 0.125, 0.4}) {
        const auto probing = make_noise_aware_probing(pattern, width);
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const Matrix3Xf points = partial_target(seed, GetParam());
            const KernelTwin twin(pattern, width, points, GetParam());
            const auto found = probed(*probing, pattern, test::target_of(points), GetParam());
            for (int i = 0; i < pattern.size(); ++i) {
                const Vector3d p = found[static_cast<std::size_t>(i)].cast<double>();
                ASSERT_LT((p - twin.point(i)).norm(), 1e-4)
                    << "node " << i << ", width " << width
                    << (twin.supported(i) ? "" : ", without support");
            }
        }
    }
}

TEST_P(NoiseAwareTwin, OfAPointOutOfReachIsNothing) {
    // The only point is over the rim and too far from most nodes to count for any of them.
    const Pattern pattern = Pattern::grid(8);
    const auto probing = make_noise_aware_probing(pattern, 0.05);
    const Matrix3Xf points = Vector3f(1.09F, 0.0F, 0.4F);
    const auto found = probed(*probing, pattern, test::target_of(points), GetParam());
    for (int i = 0; i < pattern.size(); ++i) {
        EXPECT_EQ(found[static_cast<std::size_t>(i)], pattern.point(i));
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, NoiseAwareTwin, testing::Bool(),
                         [](const auto& shape) { return shape.param ? "Curve" : "Surface"; });

/// A pattern whose nodes do not lie in the plane.
Pattern raised_pattern() {
    Random random(4);
    Matrix3Xf offsets(3, 40);
    for (Eigen::Index i = 0; i < offsets.cols(); ++i) {
        for (int c = 0; c < 3; ++c) offsets(c, i) = static_cast<float>(random.uniform(-0.6, 0.6));
    }
    return Pattern::from_points(offsets);
}

float plane_height(float x, float y) { return 0.3F * x - 0.2F * y + 0.1F; }

TEST(RaisedPattern, LandsOnThePointsUnderEveryOperator) {
    const Pattern pattern = raised_pattern();
    Random random(2);
    Matrix3Xf points(3, 4000);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const auto x = static_cast<float>(random.uniform(-1.1, 1.1));
        const auto y = static_cast<float>(random.uniform(-1.1, 1.1));
        points.col(i) << x, y, plane_height(x, y);
    }
    const TargetArea target = test::target_of(points);
    for (const auto& probing :
         {make_orthogonal_probing(pattern), make_nearest_point_probing(pattern),
          make_noise_aware_probing(pattern, 0.1)}) {
        for (const Vector3f& p : probed(*probing, pattern, target)) {
            EXPECT_NEAR(p.z(), plane_height(p.x(), p.y()), 0.06F);
        }
    }
}

TEST(OrthogonalProbing, TakesTheFirstOfPointsAboveEachOther) {
    const Pattern pattern = Pattern::grid(8);
    Matrix3Xf points(3, 24);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points.col(i) << 0.1F * static_cast<float>(i % 8), 0.2F, 0.1F * static_cast<float>(i / 8);
    }
    for (const Vector3f& p :
         probed(*make_orthogonal_probing(pattern), pattern, test::target_of(points))) {
        EXPECT_EQ(p.z(), 0.0F);
    }
}

/// One mesh in frame coordinates, with all of its samples as the target area.
struct MeshProbe {
    explicit MeshProbe(Shape shape) : mesh(std::move(shape)) {}

    std::vector<Vector3f> operator()(const Pattern& pattern) const {
        TargetArea target;
        Frame frame;
        frame.centre.setZero();
        grid.gather(frame.centre, frame.radius, 10.0F, target);
        const auto probing = make_nearest_triangle_probing(pattern, mesh, samples, grid);
        return probed(*probing, pattern, target);
    }

    Shape mesh;
    MeshSamples samples = sample_mesh(mesh, 0.05);
    PointGrid grid{samples.points, 0.5};
};

/// A tilted square sheet of n x n pairs of triangles.
Shape tilted_sheet(int n) {
    Shape sheet;
    sheet.cloud.points.resize(3, (n + 1) * (n + 1));
    sheet.triangles.resize(3, 2 * n * n);
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            const double x = 3.0 * i / n - 1.5;
            const double y = 3.0 * j / n - 1.5;
            sheet.cloud.points.col(j * (n + 1) + i) << x, y, 0.3 * x - 0.2 * y + 0.1;
        }
    }
    Eigen::Index next = 0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const auto at = static_cast<std::uint32_t>(j * (n + 1) + i);
            const auto up = at + static_cast<std::uint32_t>(n) + 1;
            sheet.triangles.col(next++) << at, at + 1, up;
            sheet.triangles.col(next++) << at + 1, up + 1, up;
        }
    }
    return sheet;
}

TEST(NearestTriangleProbing, MeetsFineMeshesStraightAboveItsNodes) {
    const Pattern pattern = Pattern::grid(8);
    const auto found = MeshProbe(tilted_sheet(40))(pattern);
    for (int i = 0; i < pattern.size(); ++i) {
        const Vector3f p = found[static_cast<std::size_t>(i)];
        EXPECT_LT((p.head<2>() - pattern.point(i).head<2>()).norm(), 1e-6F);
        EXPECT_NEAR(p.z(), plane_height(p.x(), p.y()), 1e-5F);
    }
}

TEST(NearestTriangleProbing, OfARaisedPatternLandsOnTheMesh) {
    for (const Vector3f& p : MeshProbe(tilted_sheet(4))(raised_pattern())) {
        EXPECT_NEAR(p.z(), plane_height(p.x(), p.y()), 1e-5F);
    }
}

Shape triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    Shape shape;
    shape.cloud.points.resize(3, 3);
    shape.cloud.points << a, b, c;
    shape.triangles.resize(3, 1);
    shape.triangles << 0, 1, 2;
    return shape;
}

TEST(NearestTriangleProbing, FindsTheNearestOfAllThreeSides) {
    const Vector3d corners[3] = {{-0.2, -0.2, 0.1}, {0.25, -0.1, 0.2}, {0.0, 0.3, -0.1}};
    const Pattern pattern = Pattern::grid(8);
    const auto expected = MeshProbe(triangle(corners[0], corners[1], corners[2]))(pattern);
    for (int turn = 1; turn < 3; ++turn) {
        const auto turned = MeshProbe(
            triangle(corners[turn % 3], corners[(turn + 1) % 3], corners[(turn + 2) % 3]))(pattern);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_LT((turned[i] - expected[i]).norm(), 1e-5F) << "the order of corners matters";
        }
    }
}

TEST(NearestTriangleProbing, OfEquallyNearSidesTakesTheOneNearerToThePlane) {
    // A wall seen from above: both of its long sides project onto the same line.
    const Vector3d low(0, -1, 0.1);
    const Vector3d high(0, -1, 0.6);
    const Vector3d low_end(0, 1, 0.1);
    const Pattern pattern = Pattern::grid(4);
    for (const Shape& wall : {triangle(low, high, low_end), triangle(high, low, low_end),
                              triangle(low_end, high, low)}) {
        for (const Vector3f& p : MeshProbe(wall)(pattern)) EXPECT_NEAR(p.z(), 0.1F, 1e-5F);
    }
}

/// Triangles of all sizes anywhere about the disk, which leave gaps between them.
Shape scattered_triangles(int count) {
    Random random(7);
    Shape soup;
    soup.cloud.points.resize(3, 3 * count);
    soup.triangles.resize(3, count);
    for (int t = 0; t < count; ++t) {
        const Vector3d middle(random.uniform(-1, 1), random.uniform(-1, 1), 0.4 * random.normal());
        const double size = std::exp(random.uniform(-4, -0.5));
        for (int c = 0; c < 3; ++c) {
            soup.cloud.points.col(3 * t + c) =
                middle + size * Vector3d(random.normal(), random.normal(), random.normal());
        }
        const auto first = static_cast<std::uint32_t>(3 * t);
        soup.triangles.col(t) << first, first + 1, first + 2;
    }
    return soup;
}

/// Height of a triangle straight above or below a place, if it is there.
std::optional<double> height_at(const Shape& mesh, Eigen::Index t, double x, double y) {
    const auto corner = [&](int c) { return mesh.cloud.points.col(mesh.triangles(c, t)); };
    Eigen::Matrix3d weights;
    for (int c = 0; c < 3; ++c) weights.col(c) << corner(c).x(), corner(c).y(), 1;
    const Vector3d share = weights.inverse() * Vector3d(x, y, 1);
    if (share.minCoeff() < 0) return std::nullopt;
    return share[0] * corner(0).z() + share[1] * corner(1).z() + share[2] * corner(2).z();
}

/// Squared distance in the plane from a place to the nearest side of any triangle.
double squared_distance_to_sides(const Shape& mesh, double x, double y) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        for (int c = 0; c < 3; ++c) {
            const Eigen::Vector2d a = mesh.cloud.points.col(mesh.triangles(c, t)).head<2>();
            const Eigen::Vector2d b =
                mesh.cloud.points.col(mesh.triangles((c + 1) % 3, t)).head<2>();
            const double along = (Eigen::Vector2d(x, y) - a).dot(b - a) / (b - a).squaredNorm();
            const Eigen::Vector2d at = a + std::clamp(along, 0.0, 1.0) * (b - a);
            least = std::min(least, (at - Eigen::Vector2d(x, y)).squaredNorm());
        }
    }
    return least;
}

TEST(NearestTriangleProbing, FindsWhatASearchThroughAllTrianglesFinds) {
    const Shape soup = scattered_triangles(60);
    const MeshProbe probe(soup);
    for (const Pattern& pattern : {Pattern::grid(16), Pattern::random_disk(150, 3)}) {
        const auto found = probe(pattern);
        int above = 0;
        int beside = 0;
        for (int i = 0; i < pattern.size(); ++i) {
            const Vector3d node = pattern.point(i).cast<double>();
            const Vector3d place = found[static_cast<std::size_t>(i)].cast<double>();
            double nearest = std::numeric_limits<double>::infinity();
            for (Eigen::Index t = 0; t < soup.triangles.cols(); ++t) {
                const auto height = height_at(soup, t, node.x(), node.y());
                if (height && std::abs(*height) < std::abs(nearest)) nearest = *height;
            }
            if (std::isfinite(nearest)) {
                ++above;
                ASSERT_NEAR((place.head<2>() - node.head<2>()).norm(), 0, 1e-6);
                ASSERT_NEAR(place.z(), nearest, 1e-4);
            } else {
                ++beside;
                ASSERT_NEAR((place.head<2>() - node.head<2>()).norm(),
                            std::sqrt(squared_distance_to_sides(soup, node.x(), node.y())), 1e-4);
            }
        }
        EXPECT_GT(above, 30);
        EXPECT_GT(beside, 30);
    }
}

TEST(SampleMesh, TakesTheCentroidsOfEveryPartOfATriangle) {
    // The longest side, across from the first corner, is 3: four cuts, sixteen parts.
    const Shape shape = triangle({0, 0, 0}, {1.6, 0, 0}, {-1.4, 0, 0.001});
    const MeshSamples samples = sample_mesh(shape, 0.76);
    EXPECT_EQ(samples.points.cols(), 16);
    EXPECT_EQ(samples.triangle, std::vector<std::uint32_t>(16, 0));
    const Vector3d centroid = shape.cloud.points.rowwise().mean();
    EXPECT_LT((samples.points.rowwise().mean() - centroid).norm(), 1e-12);
}

}  // namespace
}  // namespace lpf
