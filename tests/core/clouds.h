#pragma once

#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "core/shape/point_cloud.h"

namespace lpf::test {

/// A small cloud with a name, for tests that must hold on every kind of input.
struct NamedCloud {
    std::string name;
    Points points;
};

inline void PrintTo(const NamedCloud& cloud, std::ostream* out) { *out << cloud.name; }

/// `count` points, uniform in the box [low, high)^3.
Points random_box(std::size_t count, std::uint64_t seed, double low = 0.0, double high = 1.0);

/// Each point after its move.
Points moved(const Points& points, const std::vector<Eigen::Vector3f>& moves);

/// The lattice [0, side)^3 with step 1.
Points lattice(int side);

/// Clouds without structure, with ties, with repeats, flat, straight, far away, and tiny ones.
const std::vector<NamedCloud>& awkward_clouds();

/// For the name of a parameterised test.
struct CloudName {
    template <typename Info>
    std::string operator()(const Info& info) const {
        return info.param.name;
    }
};

}  // namespace lpf::test
