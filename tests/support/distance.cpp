#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/metrics.h"

namespace lpf::test {
namespace {

std::vector<Eigen::AlignedBox3d> boxes_of(const Points& points) {
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(static_cast<std::size_t>(points.cols()));
    for (Eigen::Index i = 0; i < points.cols(); ++i) boxes.emplace_back(Vector3d(points.col(i)));
    return boxes;
}

double squared_distance_to_segment(const Vector3d& query, const Vector3d& a, const Vector3d& b) {
    const Vector3d edge = b - a;
    const double length2 = edge.squaredNorm();
    const double t = length2 > 0 ? std::clamp((query - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
    return (query - a - t * edge).squaredNorm();
}

}  // namespace

CloudDistance::CloudDistance(const Points& points) : points_(points), bvh_(boxes_of(points)) {}

double CloudDistance::operator()(const Vector3d& query) const {
    const Bvh::Hit hit = bvh_.nearest(
        query, [&](std::uint32_t i) { return (points_.col(i) - query).squaredNorm(); });
    return std::sqrt(hit.squared_distance);
}

double CloudDistance::to_others(const Vector3d& query, std::uint32_t left_out) const {
    const Bvh::Hit hit = bvh_.nearest(query, [&](std::uint32_t i) {
        return i == left_out ? std::numeric_limits<double>::infinity()
                             : (points_.col(i) - query).squaredNorm();
    });
    return std::sqrt(hit.squared_distance);
}

MeshDistance::MeshDistance(const Points& vertices, const Triangles& triangles)
    : vertices_(vertices), triangles_(triangles) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (Eigen::Index f = 0; f < triangles.cols(); ++f) {
        Eigen::AlignedBox3d box;
        for (int c = 0; c < 3; ++c) box.extend(Vector3d(vertices.col(triangles(c, f))));
        boxes.push_back(box);
    }
    bvh_ = Bvh(boxes);
}

double MeshDistance::operator()(const Vector3d& query) const {
    const Bvh::Hit hit = bvh_.nearest(query, [&](std::uint32_t f) {
        return squared_distance_to_triangle(query, vertices_.col(triangles_(0, f)),
                                            vertices_.col(triangles_(1, f)),
                                            vertices_.col(triangles_(2, f)));
    });
    return std::sqrt(hit.squared_distance);
}

double squared_distance_to_triangle(const Vector3d& query, const Vector3d& a, const Vector3d& b,
                                    const Vector3d& c) {
    const Vector3d normal = (b - a).cross(c - a);
    const auto inside_of = [&](const Vector3d& from, const Vector3d& to) {
        return normal.dot((to - from).cross(query - from)) >= 0;
    };
    const bool above = inside_of(a, b) && inside_of(b, c) && inside_of(c, a);
    if (above && normal.squaredNorm() > 0) {
        const double height = normal.dot(query - a);
        return height * height / normal.squaredNorm();
    }
    return std::min({squared_distance_to_segment(query, a, b),
                     squared_distance_to_segment(query, b, c),
                     squared_distance_to_segment(query, c, a)});
}

}  // namespace lpf::test
