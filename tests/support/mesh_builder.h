#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/shape/shape.h"

namespace lpf::test {

/// Collects vertices, each place once, and triangles over them.
class MeshBuilder {
public:
    using Corners = std::array<std::uint32_t, 3>;

    std::uint32_t vertex(const Eigen::Vector3d& at) {
        const std::array<long, 3> key{std::lround(at.x() * 1e9), std::lround(at.y() * 1e9),
                                      std::lround(at.z() * 1e9)};
        const auto [found, added] = known_.try_emplace(key, vertices_.size());
        if (added) vertices_.push_back(at);
        return static_cast<std::uint32_t>(found->second);
    }

    /// Adds a triangle, unless two of its corners are the same.
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && c != a) triangles_.push_back({a, b, c});
    }

    /// The quadrangle a b c d as two triangles.
    void quadrangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }

    [[nodiscard]] const Eigen::Vector3d& at(std::uint32_t i) const { return vertices_[i]; }
    [[nodiscard]] std::vector<Corners> take_triangles() { return std::exchange(triangles_, {}); }

    /// What was collected, all lengths times `scale`.
    [[nodiscard]] Shape shape(double scale = 1.0) const {
        Shape result;
        result.cloud.points.resize(3, static_cast<Eigen::Index>(vertices_.size()));
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            result.cloud.points.col(static_cast<Eigen::Index>(i)) = scale * vertices_[i];
        }
        result.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
        for (std::size_t f = 0; f < triangles_.size(); ++f) {
            for (int c = 0; c < 3; ++c) {
                result.triangles(c, static_cast<Eigen::Index>(f)) =
                    triangles_[f][static_cast<std::size_t>(c)];
            }
        }
        return result;
    }

private:
    std::vector<Eigen::Vector3d> vertices_;
    std::vector<Corners> triangles_;
    std::map<std::array<long, 3>, std::size_t> known_;
};

}  // namespace lpf::test
