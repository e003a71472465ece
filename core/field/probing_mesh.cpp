// The operator for triangle meshes.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/field/probing.h"

namespace lpf {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kFinestSubdivision = 1024;

using Triangle = std::array<Eigen::Vector3f, 3>;

/// What a triangle covers of the plane.
Eigen::AlignedBox2f shadow_of(const Triangle& corners) {
    Eigen::AlignedBox2f shadow(corners[0].head<2>());
    for (const Eigen::Vector3f& corner : corners) shadow.extend(corner.head<2>());
    return shadow;
}

/// With a rim, so that rounding finds nothing outside of it.
Eigen::AlignedBox2f with_rim(const Eigen::AlignedBox2f& shadow) {
    constexpr float kShare = 1e-4F;
    constexpr float kLeast = 1e-6F;
    const Eigen::Vector2f rim =
        Eigen::Vector2f::Constant(kShare * shadow.sizes().maxCoeff() + kLeast);
    return {shadow.min() - rim, shadow.max() + rim};
}

/// Nodes that follow each other, of one y and with ascending x.
struct NodeRow {
    float y;
    int first;
    int end;
};

/// Of a grid, with ascending y; of other patterns, each node is one.
std::vector<NodeRow> rows_of(const Pattern& pattern) {
    std::vector<NodeRow> rows;
    const float* y = pattern.channel(1);
    for (int i = 0; i < pattern.size(); ++i) {
        if (pattern.grid_size() > 0 && i > 0 && y[i] == y[i - 1]) {
            rows.back().end = i + 1;
        } else {
            rows.push_back({y[i], i, i + 1});
        }
    }
    std::ranges::sort(rows, {}, &NodeRow::y);
    return rows;
}

/// Nearest point of segment ab to (x, y) in the plane: its height and squared distance.
void nearest_on_segment(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float x, float y,
                        float& best_squared, Eigen::Vector3f& best) {
    const Eigen::Vector2f along = (b - a).head<2>();
    const float length = along.squaredNorm();
    const float t = length > 0 ? (Eigen::Vector2f(x, y) - a.head<2>()).dot(along) / length : 0.0F;
    const Eigen::Vector3f at = a + std::clamp(t, 0.0F, 1.0F) * (b - a);
    const float squared = (at.head<2>() - Eigen::Vector2f(x, y)).squaredNorm();
    if (squared < best_squared ||
        (squared == best_squared && std::abs(at.z()) < std::abs(best.z()))) {
        best_squared = squared;
        best = at;
    }
}

class NearestTriangleProbing final : public ProbingOperator {
public:
    NearestTriangleProbing(const Pattern& pattern, const Shape& mesh, const MeshSamples& samples,
                           const PointGrid& grid)
        : pattern_(pattern),
          rows_(rows_of(pattern_)),
          mesh_(mesh),
          samples_(samples),
          grid_(grid) {}

    void probe(const Frame& frame, bool, ProbeScratch& scratch, float* v) const override {
        const int m = pattern_.size();
        const int stride = pattern_.padded_size();
        std::fill_n(v, 3 * stride, 0.0F);
        if (scratch.target.size == 0) return;
        collect_triangles(frame, scratch);
        const std::size_t count = scratch.triangles.size();

        scratch.raster2.assign(static_cast<std::size_t>(stride), kInfinity);
        float* height = scratch.raster2.data();
        for (std::size_t t = 0; t < count; ++t) intersect_normals(triangle(scratch, t), height);
        for (int i = 0; i < m; ++i) {
            if (height[i] != kInfinity) {
                v[2 * stride + i] = height[i] - pattern_.channel(2)[i];
                continue;
            }
            const Eigen::Vector3f point = nearest_in_plane(scratch, i);
            for (int c = 0; c < 3; ++c) v[c * stride + i] = point[c] - pattern_.channel(c)[i];
        }
    }

private:
    /// The triangles of the target area, without repetition, their corners in frame coordinates.
    void collect_triangles(const Frame& frame, ProbeScratch& scratch) const {
        std::vector<std::uint32_t>& found = scratch.triangles;
        found.clear();
        for (std::size_t i = 0; i < scratch.target.size; ++i) {
            const std::uint32_t t = samples_.triangle[grid_.order()[scratch.target.index[i]]];
            if (found.empty() || found.back() != t) found.push_back(t);  // fewer to sort
        }
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
        scratch.raster.resize(9 * found.size());
        float* out = scratch.raster.data();
        for (const std::uint32_t t : found) {
            for (int corner = 0; corner < 3; ++corner) {
                const Eigen::Vector3f local =
                    frame.to_local(mesh_.cloud.points.col(mesh_.triangles(corner, t)));
                out = std::copy_n(local.data(), 3, out);
            }
        }
    }

    [[nodiscard]] static Triangle triangle(const ProbeScratch& scratch, std::size_t t) {
        const float* at = scratch.raster.data() + 9 * t;
        return {Eigen::Vector3f(at[0], at[1], at[2]), Eigen::Vector3f(at[3], at[4], at[5]),
                Eigen::Vector3f(at[6], at[7], at[8])};
    }

    /// Where the normal through each node meets the triangle, if that is nearer to the plane.
    void intersect_normals(const Triangle& corners, float* height) const {
        const Eigen::Vector3f ab = corners[1] - corners[0];
        const Eigen::Vector3f ac = corners[2] - corners[0];
        const float area = ab.x() * ac.y() - ab.y() * ac.x();
        if (std::abs(area) < 1e-12F) return;  // seen from the side
        const float inverse = 1 / area;
        constexpr float kRim = -1e-5F;  // neighbours leave no gap between them
        const float* x = pattern_.channel(0);
        const float* y = pattern_.channel(1);
        const Eigen::AlignedBox2f shadow = with_rim(shadow_of(corners));
        const auto meet = [&](std::ptrdiff_t i) {
            const float px = x[i] - corners[0].x();
            const float py = y[i] - corners[0].y();
            const float b = (px * ac.y() - py * ac.x()) * inverse;
            const float c = (ab.x() * py - ab.y() * px) * inverse;
            const float z = corners[0].z() + b * ab.z() + c * ac.z();
            const bool hit = b >= kRim && c >= kRim && b + c <= 1 - kRim;
            if (hit && std::abs(z) < std::abs(height[i])) height[i] = z;
        };
        for (auto row = std::ranges::lower_bound(rows_, shadow.min().y(), {}, &NodeRow::y);
             row != rows_.end() && row->y <= shadow.max().y(); ++row) {
            const float* const end = x + row->end;
            for (const float* node = std::lower_bound(x + row->first, end, shadow.min().x());
                 node != end && *node <= shadow.max().x(); ++node) {
                meet(node - x);
            }
        }
    }

    [[nodiscard]] Eigen::Vector3f nearest_in_plane(const ProbeScratch& scratch, int node) const {
        const float x = pattern_.channel(0)[node];
        const float y = pattern_.channel(1)[node];
        Eigen::Vector3f best = pattern_.point(node);
        float squared = kInfinity;
        constexpr float kRoundingDown = 0.9999F;
        for (std::size_t t = 0; t < scratch.triangles.size(); ++t) {
            const Triangle corners = triangle(scratch, t);
            if (kRoundingDown * shadow_of(corners).squaredExteriorDistance(Eigen::Vector2f(x, y)) >
                squared)
                continue;
            for (std::size_t side = 0; side < 3; ++side) {
                nearest_on_segment(corners[side], corners[(side + 1) % 3], x, y, squared, best);
            }
        }
        return best;
    }

    Pattern pattern_;
    std::vector<NodeRow> rows_;
    const Shape& mesh_;
    const MeshSamples& samples_;
    const PointGrid& grid_;
};

}  // namespace

MeshSamples sample_mesh(const Shape& mesh, double spacing) {
    MeshSamples samples;
    std::vector<Eigen::Vector3d> points;
    for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
        const Eigen::Vector3d a = mesh.cloud.points.col(mesh.triangles(0, t));
        const Eigen::Vector3d ab = mesh.cloud.points.col(mesh.triangles(1, t)) - a;
        const Eigen::Vector3d ac = mesh.cloud.points.col(mesh.triangles(2, t)) - a;
        const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
        const int k = static_cast<int>(
            std::clamp(std::ceil(longest / spacing), 1.0, double{kFinestSubdivision}));
        // Centroids of the k^2 congruent triangles that k cuts a side make.
        const auto add = [&](double i, double j) {
            points.emplace_back(a + (i * ab + j * ac) / k);
            samples.triangle.push_back(static_cast<std::uint32_t>(t));
        };
        for (int j = 0; j < k; ++j) {
            for (int i = 0; i + j < k; ++i) {
                add(i + 1.0 / 3, j + 1.0 / 3);
                if (i + j + 1 < k) add(i + 2.0 / 3, j + 2.0 / 3);
            }
        }
    }
    samples.points.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        samples.points.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    return samples;
}

std::unique_ptr<ProbingOperator> make_nearest_triangle_probing(const Pattern& pattern,
                                                               const Shape& mesh,
                                                               const MeshSamples& samples,
                                                               const PointGrid& grid) {
    return std::make_unique<NearestTriangleProbing>(pattern, mesh, samples, grid);
}

}  // namespace lpf
