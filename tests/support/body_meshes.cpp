#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/mesh_builder.h"
#include "tests/support/meshes.h"

namespace lpf::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A groove across the side of the pyramid: its middle along the slope, its width, its depth.
struct Groove {
    double at;
    double width;
    double depth;
    bool flat_floor;
};

constexpr double kBase = 40.0;  // half the side of the base
constexpr double kHeight = 54.34;

/// The outline of a side, from the base to the top: half the side of the square, and its height.
std::vector<Vector2d> pyramid_profile() {
    const Vector2d slope = Vector2d(-kBase, kHeight).normalized();
    const Vector2d outward(slope.y(), -slope.x());
    const auto place = [&](double along, double off) -> Vector2d {
        return Vector2d(kBase, 0) + along * slope + off * outward;
    };
    std::vector<Groove> grooves;
    for (int i = 0; i < 5; ++i) grooves.push_back({5.0 + 4.0 * i, 0.5 + 0.5 * i, 0.5, false});
    for (int i = 0; i < 4; ++i) grooves.push_back({25.5 + 4.0 * i, 2.5 - 0.5 * i, 0.6, true});
    for (int i = 0; i < 9; ++i) grooves.push_back({41.0 + 2.0 * i, 0.8, 0.3, false});

    std::vector<Vector2d> profile{place(0, 0)};
    for (const Groove& groove : grooves) {
        const double low = groove.at - groove.width / 2, high = groove.at + groove.width / 2;
        profile.push_back(place(low, 0));
        if (groove.flat_floor) {
            profile.push_back(place(low, -groove.depth));
            profile.push_back(place(high, -groove.depth));
        } else {
            profile.push_back(place(groove.at, -groove.depth));
        }
        profile.push_back(place(high, 0));
    }
    profile.emplace_back(0, kHeight);
    return profile;
}

/// The top of the turned disk: distance from the axis and height, from the hub to the rim.
std::vector<Vector2d> disk_profile() {
    std::vector<Vector2d> top{{2.0, 1.9}, {3.0, 1.9}, {3.0, 1.5}, {3.4, 1.5}};
    for (int i = 0; i <= 24; ++i) {  // a fillet of radius .9, down to the web
        const double angle = std::numbers::pi / 2 * i / 24;
        top.emplace_back(4.3 - 0.9 * std::cos(angle), 1.5 - 0.9 * std::sin(angle));
    }
    top.insert(top.end(),
               {{4.8, 0.6}, {4.9, 0.45}, {5.0, 0.6}, {5.4, 0.6}, {5.4, 1.2}, {6.0, 1.4}});
    for (int i = 1; i <= 12; ++i) {  // a rounded outer rim
        const double angle = std::numbers::pi / 2 * i / 12;
        top.emplace_back(6.0 + 0.4 * std::sin(angle), 1.0 + 0.4 * std::cos(angle));
    }
    return top;
}

Shape with_diagonal(Shape mesh, double diagonal) {
    const Vector3d low = mesh.cloud.points.rowwise().minCoeff();
    const Vector3d high = mesh.cloud.points.rowwise().maxCoeff();
    mesh.cloud.points *= diagonal / (high - low).norm();
    return mesh;
}

/// How far the head reaches in a direction, in units of its mean radius.
double head_reach(const Vector3d& direction) {
    const double azimuth = std::atan2(direction.y(), direction.x());
    const double height = direction.z();
    const double long_skull = 1.0 + 0.16 * height * height - 0.10 * direction.y() * direction.y();
    const double face = std::exp(-4.0 * (direction - Vector3d(1, 0, -0.15)).squaredNorm());
    const double nose = std::exp(-60.0 * (direction - Vector3d(0.98, 0, -0.1)).squaredNorm());
    const double brow = std::exp(-50.0 * std::pow(height - 0.22, 2)) * face;
    const double locks = std::cos(24 * azimuth) * std::cos(36 * height);
    // Locks fade out over the face and towards the poles, where the meridians meet.
    const double hair = (1 - std::min(1.0, 1.6 * face)) * std::max(0.0, 1 - height * height);
    return long_skull + 0.05 * face + 0.14 * nose + 0.05 * brow + 0.025 * hair * locks;
}

}  // namespace

Shape pyramid_mesh() {
    MeshBuilder mesh;
    const std::vector<Vector2d> profile = pyramid_profile();
    const double turn[4][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    const auto corner = [&](std::size_t ring, int k) {
        const Vector2d& p = profile[ring];
        return mesh.vertex({p.x() * turn[k % 4][0], p.x() * turn[k % 4][1], p.y()});
    };
    for (int k = 0; k < 4; ++k) (void)corner(0, k);  // vertices 0 to 3
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        for (int k = 0; k < 4; ++k) {
            mesh.quadrangle(corner(i, k), corner(i, k + 1), corner(i + 1, k + 1), corner(i + 1, k));
        }
    }
    return mesh.shape();
}

Shape disk_segment_mesh() {
    constexpr int kSteps = 96;
    constexpr double kAngle = std::numbers::pi / 3;
    MeshBuilder mesh;
    const std::vector<Vector2d> top = disk_profile();
    const auto place = [&](double reach, double height, int step) {
        const double angle = kAngle * step / kSteps;
        return mesh.vertex({reach * std::cos(angle), reach * std::sin(angle), height});
    };
    const auto upper = [&](std::size_t i, int k) { return place(top[i].x(), top[i].y(), k); };
    const auto lower = [&](std::size_t i, int k) { return place(top[i].x(), 0.0, k); };
    const std::size_t last = top.size() - 1;
    for (int k = 0; k < kSteps; ++k) {
        mesh.quadrangle(lower(0, k), upper(0, k), upper(0, k + 1), lower(0, k + 1));
        mesh.quadrangle(upper(last, k), lower(last, k), lower(last, k + 1), upper(last, k + 1));
        for (std::size_t i = 0; i < last; ++i) {
            mesh.quadrangle(upper(i, k), upper(i + 1, k), upper(i + 1, k + 1), upper(i, k + 1));
            mesh.quadrangle(lower(i, k), lower(i, k + 1), lower(i + 1, k + 1), lower(i + 1, k));
        }
    }
    for (std::size_t i = 0; i < last; ++i) {  // the two cuts
        mesh.quadrangle(lower(i, 0), lower(i + 1, 0), upper(i + 1, 0), upper(i, 0));
        mesh.quadrangle(lower(i, kSteps), upper(i, kSteps), upper(i + 1, kSteps),
                        lower(i + 1, kSteps));
    }
    return with_diagonal(mesh.shape(), 7.6156);  // that of the Fandisk model
}

Shape head_mesh() {
    Shape head = icosphere(1.0, 6);
    for (Eigen::Index i = 0; i < head.cloud.points.cols(); ++i) {
        head.cloud.points.col(i) *= head_reach(head.cloud.points.col(i));
    }
    return with_diagonal(std::move(head), 51.96);
}

}  // namespace lpf::test
