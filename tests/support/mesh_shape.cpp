#include "tests/support/mesh_shape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tests/support/metrics.h"

namespace lpf::test {
namespace {

/// (b - a) x (c - a) of a triangle: its normal, as long as twice its area.
Vector3d area_normal(const Shape& mesh, Eigen::Index face) {
    const Points& points = mesh.cloud.points;
    const auto& corners = mesh.triangles.col(face);
    const Vector3d a = points.col(corners[0]), b = points.col(corners[1]);
    return (b - a).cross(Vector3d(points.col(corners[2])) - a);
}

class MeshSurface final : public Piece {
public:
    explicit MeshSurface(const Shape& mesh)
        : mesh_(mesh), distance_(mesh.cloud.points, mesh.triangles) {
        for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
            area_.push_back((area_.empty() ? 0.0 : area_.back()) + area_normal(mesh, f).norm() / 2);
            for (int c = 0; c < 3; ++c) box_.extend(corner(f, c));
        }
    }

    int dimension() const override { return 2; }
    double measure() const override { return area_.back(); }
    Vector3d sample(Random& random) const override {
        const auto found =
            std::upper_bound(area_.begin(), area_.end() - 1, random.uniform() * area_.back());
        const auto f = static_cast<Eigen::Index>(found - area_.begin());
        const double root = std::sqrt(random.uniform());  // uniform by area within the triangle
        const double share = random.uniform();
        return (1 - root) * corner(f, 0) + root * (1 - share) * corner(f, 1) +
               root * share * corner(f, 2);
    }
    double squared_distance(const Vector3d& point) const override {
        const double distance = distance_(point);
        return distance * distance;
    }
    Eigen::AlignedBox3d box() const override { return box_; }

private:
    Vector3d corner(Eigen::Index face, int c) const {
        return mesh_.cloud.points.col(mesh_.triangles(c, face));
    }

    Shape mesh_;
    MeshDistance distance_;
    std::vector<double> area_;  // up to and with each triangle
    Eigen::AlignedBox3d box_;
};

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

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// The triangles at each edge.
std::map<Edge, std::vector<Eigen::Index>> edges_of(const Triangles& triangles) {
    std::map<Edge, std::vector<Eigen::Index>> faces;
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
        for (int c = 0; c < 3; ++c) {
            faces[std::minmax(triangles(c, f), triangles((c + 1) % 3, f))].push_back(f);
        }
    }
    return faces;
}

bool is_sharp(const Shape& mesh, const std::vector<Eigen::Index>& faces, double degrees) {
    if (faces.size() != 2) return false;
    const Vector3d a = area_normal(mesh, faces[0]), b = area_normal(mesh, faces[1]);
    return a.dot(b) < std::cos(degrees * std::numbers::pi / 180) * a.norm() * b.norm();
}

std::vector<PiecePtr> joined(std::vector<PiecePtr> parts) {
    if (parts.empty()) return {};
    return {std::make_shared<Segments>(std::move(parts))};
}

}  // namespace

TestShape make_mesh_shape(const Shape& mesh, const Sampling& sampling, double sharp_degrees) {
    std::vector<PiecePtr> borders, sharp;
    for (const auto& [edge, faces] : edges_of(mesh.triangles)) {
        const Vector3d from = mesh.cloud.points.col(edge.first);
        const Vector3d to = mesh.cloud.points.col(edge.second);
        if (from == to) continue;
        if (faces.size() == 1) borders.push_back(segment(from, to));
        if (is_sharp(mesh, faces, sharp_degrees)) sharp.push_back(segment(from, to));
    }
    TestShape shape{"mesh", {std::make_shared<MeshSurface>(mesh)}, joined(std::move(borders))};
    shape.edges = joined(std::move(sharp));
    return sampled(std::move(shape), sampling);
}

}  // namespace lpf::test
