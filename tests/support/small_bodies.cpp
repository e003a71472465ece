#include <cmath>
#include <numbers>
#include <utility>

#include "tests/support/shapes.h"
#include "tests/support/solids.h"

namespace lpf::test {
namespace {

using Solids = std::vector<SolidPtr>;

/// A horizontal or upright block around a centre.
SolidPtr slab(const Vector3d& centre, const Vector3d& size) {
    return block(centre - size / 2, centre + size / 2);
}

Solids table() {
    Solids solids{slab({0, 0, 1}, {2, 1.2, 0.1})};
    for (const double x : {-0.9, 0.9}) {
        for (const double y : {-0.5, 0.5}) solids.push_back(capsule({x, y, 0}, {x, y, 1}, 0.06));
    }
    return solids;
}

Solids chair() {
    Solids solids{slab({0, 0, 0.5}, {0.9, 0.9, 0.08}), slab({0, 0.41, 1}, {0.9, 0.08, 1})};
    for (const double x : {-0.4, 0.4}) {
        for (const double y : {-0.4, 0.4}) {
            solids.push_back(slab({x, y, 0.25}, {0.1, 0.1, 0.5}));
        }
    }
    return solids;
}

Solids animal() {
    Solids solids{
        capsule({-0.6, 0, 1}, {0.6, 0, 1}, 0.3), capsule({0.7, 0, 1.1}, {1, 0, 1.6}, 0.15),
        capsule({1, 0, 1.65}, {1.3, 0, 1.6}, 0.14), capsule({-0.9, 0, 1.1}, {-1.4, 0, 0.8}, 0.05)};
    for (const double x : {-0.6, 0.6}) {
        for (const double y : {-0.18, 0.18})
            solids.push_back(capsule({x, y, 0.8}, {x, y, 0}, 0.09));
    }
    for (const double y : {-0.1, 0.1}) {
        solids.push_back(capsule({0.95, y, 1.7}, {0.9, 2 * y, 1.95}, 0.04));
    }
    return solids;
}

Solids kitten() {
    return {ball({0, 0, 0.6}, 0.6),
            ball({0.35, 0, 1.35}, 0.4),
            capsule({0.3, 0.22, 1.65}, {0.3, 0.28, 1.85}, 0.08),
            capsule({0.3, -0.22, 1.65}, {0.3, -0.28, 1.85}, 0.08),
            capsule({0.4, 0.25, 0.5}, {0.7, 0.25, 0}, 0.15),
            capsule({0.4, -0.25, 0.5}, {0.7, -0.25, 0}, 0.15),
            ring({-0.75, 0, 0.3}, 0.4, 0.08)};
}

Solids star() {
    Solids solids;
    for (int k = 0; k < 5; ++k) {
        const double angle = 2 * std::numbers::pi * k / 5;
        solids.push_back(capsule({0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, 0.12));
    }
    return solids;
}

Solids frame() {
    Solids solids;
    for (const double side : {-0.9, 0.9}) {
        solids.push_back(slab({side, 0, 0}, {0.2, 2, 0.2}));
        solids.push_back(slab({0, side, 0}, {2, 0.2, 0.2}));
    }
    for (const double at : {-0.3, 0.3}) {
        solids.push_back(capsule({at, -0.9, 0}, {at, 0.9, 0}, 0.05));
    }
    return solids;
}

Solids plates() {
    Solids solids;
    for (const double z : {-0.5, 0.0, 0.5}) solids.push_back(slab({0, 0, z}, {1.6, 1.6, 0.12}));
    solids.push_back(capsule({0, 0, -0.5}, {0, 0, 0.5}, 0.15));
    return solids;
}

Solids jack() {
    Solids solids;
    for (int axis = 0; axis < 3; ++axis) {
        const Vector3d end = Vector3d::Unit(axis);
        solids.push_back(capsule(-end, end, 0.12));
        for (const double side : {-1.0, 1.0}) solids.push_back(ball(side * end, 0.22));
    }
    return solids;
}

}  // namespace

std::vector<TestShape> make_small_bodies(std::uint64_t seed) {
    constexpr std::size_t kPoints = 10000;
    const std::vector<std::pair<const char*, Solids>> bodies = {
        {"sphere", {ball({0, 0, 0}, 1)}},
        {"cube", {slab({0, 0, 0}, {2, 2, 2})}},
        {"table", table()},
        {"chair", chair()},
        {"animal", animal()},
        {"kitten", kitten()},
        {"star", star()},
        {"frame", frame()},
        {"plates", plates()},
        {"jack", jack()}};
    std::vector<TestShape> shapes;
    for (const auto& [name, solids] : bodies) {
        const PiecePtr surface = union_surface(solids);
        const double spacing = std::sqrt(surface->measure() / static_cast<double>(kPoints));
        shapes.push_back(sampled({name, {surface}}, {kPoints, spacing, seed}));
    }
    return shapes;
}

}  // namespace lpf::test
