#include "tests/core/clouds.h"

#include "core/base/random.h"

namespace lpf::test {
namespace {

Points repeated(const Points& points, int times) { return points.replicate(1, times); }

Points on_line(std::size_t count) {
    Points points = random_box(count, 5);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points.col(i) = points(0, i) * Eigen::Vector3d(1.0, 2.0, -0.5);
    }
    return points;
}

Points flat(std::size_t count) {
    Points points = random_box(count, 6);
    points.row(2).setConstant(0.25);
    return points;
}

/// Two heaps a million of their own sizes apart.
Points far_heaps(std::size_t count) {
    Points points = random_box(count, 7);
    points.rightCols(points.cols() / 2).array() += 1e6;
    return points;
}

std::vector<NamedCloud> make_clouds() {
    Points offset = random_box(400, 3);
    offset.colwise() += Eigen::Vector3d(1e7, -2e7, 3e3);
    return {{"Empty", Points(3, 0)},
            {"OnePoint", random_box(1, 1)},
            {"TwoPoints", random_box(2, 1)},
            {"Box", random_box(500, 2)},
            {"Lattice", lattice(7)},
            {"AllEqual", repeated(random_box(1, 4), 300)},
            {"Repeats", repeated(random_box(60, 4), 5)},
            {"Line", on_line(300)},
            {"Flat", flat(400)},
            {"MapCoordinates", offset},
            {"FarHeaps", far_heaps(300)},
            {"Negative", random_box(300, 8, -5.0, -4.0)}};
}

}  // namespace

Points random_box(std::size_t count, std::uint64_t seed, double low, double high) {
    Points points(3, static_cast<Eigen::Index>(count));
    Random random(seed);
    for (double& value : points.reshaped()) value = random.uniform(low, high);
    return points;
}

Points moved(const Points& points, const std::vector<Eigen::Vector3f>& moves) {
    Points all = points;
    for (std::size_t i = 0; i < moves.size(); ++i) {
        all.col(static_cast<Eigen::Index>(i)) += moves[i].cast<double>();
    }
    return all;
}

Points lattice(int side) {
    Points points(3, Eigen::Index{side} * side * side);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        points.col(i) =
            Eigen::Vector3i(static_cast<int>(i % side), static_cast<int>(i / side % side),
                            static_cast<int>(i / side / side))
                .cast<double>();
    }
    return points;
}

const std::vector<NamedCloud>& awkward_clouds() {
    static const std::vector<NamedCloud> clouds = make_clouds();
    return clouds;
}

}  // namespace lpf::test
