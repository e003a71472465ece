#include "tests/support/mesh_shape.h"

#include <algorithm>
#include <utility>

#include "tests/support/bvh.h"
#include "tests/support/meshes.h"

namespace lpf::test {
namespace {

/// Many segments as one piece, with a tree over them.
class Segments final : public Piece {
public:
    explicit Segments(std::vector<PiecePtr> parts) : parts_(std::move(parts)) {
        std::vector<Eigen::AlignedBox3d> boxes;
        for (const PiecePtr& part : parts_) {
            length_.push_back((length_.empty() ? 0.0 : length_.back()) + part->measure());
            boxes.push_back(part->box());
            box_.extend(boxes.back());
        }
        bvh_ = Bvh(boxes);
    }

    int dimension() const override { return 1; }
    double measure() const override { return length_.back(); }
    Vector3d sample(Random& random) const override {
        const auto found =
            std::upper_bound(length_.begin(), length_.end() - 1, random.uniform() * length_.back());
        return parts_[static_cast<std::size_t>(found - length_.begin())]->sample(random);
    }
    double squared_distance(const Vector3d& point) const override {
        const auto to_part = [&](std::uint32_t i) { return parts_[i]->squared_distance(point); };
        return bvh_.nearest(point, to_part).squared_distance;
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    std::vector<PiecePtr> parts_;
    std::vector<double> length_;  // up to and with each segment
    Bvh bvh_;
    Eigen::AlignedBox3d box_;
};

/// The edges of a mesh that have a length, as one piece; none if there are none.
std::vector<PiecePtr> joined(const Points& vertices, const Triangles& edges) {
    std::vector<PiecePtr> parts;
    for (Eigen::Index i = 0; i < edges.cols(); ++i) {
        const Vector3d from = vertices.col(edges(0, i)), to = vertices.col(edges(1, i));
        if (from != to) parts.push_back(segment(from, to));
    }
    if (parts.empty()) return {};
    return {std::make_shared<Segments>(std::move(parts))};
}

}  // namespace

TestShape make_mesh_shape(const Shape& mesh, const Sampling& sampling, double sharp_degrees) {
    const Points& vertices = mesh.cloud.points;
    TestShape shape{"mesh", {mesh_surface(mesh)}, joined(vertices, border_edges(mesh))};
    shape.edges = joined(vertices, sharp_edges(mesh, sharp_degrees));
    return sampled(std::move(shape), sampling);
}

}  // namespace lpf::test
