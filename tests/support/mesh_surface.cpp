#include <algorithm>
#include <cmath>

#include "tests/support/metrics.h"
#include "tests/support/pieces.h"

namespace lpf::test {
namespace {

class MeshSurface final : public Piece {
public:
    explicit MeshSurface(const Shape& mesh)
        : vertices_(mesh.cloud.points),
          triangles_(mesh.triangles),
          distance_(mesh.cloud.points, mesh.triangles) {
        for (Eigen::Index f = 0; f < triangles_.cols(); ++f) {
            const Vector3d a = corner(0, f), b = corner(1, f), c = corner(2, f);
            const double before = area_.empty() ? 0.0 : area_.back();
            area_.push_back(before + 0.5 * (b - a).cross(c - a).norm());
            box_.extend(a).extend(b).extend(c);
        }
    }

    int dimension() const override { return 2; }
    double measure() const override { return area_.back(); }
    Vector3d sample(Random& random) const override {
        const auto found =
            std::upper_bound(area_.begin(), area_.end() - 1, random.uniform() * area_.back());
        const Eigen::Index f = found - area_.begin();
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) {  // the other half of the parallelogram
            u = 1 - u;
            v = 1 - v;
        }
        const Vector3d a = corner(0, f);
        return a + u * (corner(1, f) - a) + v * (corner(2, f) - a);
    }
    double squared_distance(const Vector3d& point) const override {
        const double distance = distance_(point);
        return distance * distance;
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    Vector3d corner(int c, Eigen::Index f) const { return vertices_.col(triangles_(c, f)); }

    Points vertices_;
    Triangles triangles_;
    MeshDistance distance_;
    std::vector<double> area_;  // up to each triangle
    Eigen::AlignedBox3d box_;
};

}  // namespace

PiecePtr mesh_surface(const Shape& mesh) { return std::make_shared<MeshSurface>(mesh); }

}  // namespace lpf::test
