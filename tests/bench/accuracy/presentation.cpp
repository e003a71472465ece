#include "tests/bench/accuracy/presentation.h"

namespace lpf::accuracy {

Eigen::Matrix3d some_turn() {
    return Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
}

std::vector<Presentation> presentations() {
    std::vector<Presentation> all(1);
    for (const std::uint64_t seed : {2, 3, 4, 5}) {
        all.push_back({.name = "random seed " + std::to_string(seed), .random_seed = seed});
    }
    all.push_back(
        {.name = "1e6 away", .placing = Eigen::Affine3d(Eigen::Translation3d(1e6, -1e6, 1e6))});
    all.push_back({.name = "turned", .placing = Eigen::Affine3d(some_turn())});
    all.push_back({.name = "in mm", .placing = Eigen::Affine3d(Eigen::Scaling(1000.0))});
    return all;
}

}  // namespace lpf::accuracy
