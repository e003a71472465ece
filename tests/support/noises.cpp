#include "tests/support/noises.h"

#include <array>
#include <cmath>
#include <set>

#include "core/base/random.h"

namespace lpf::test {
namespace {

template <typename Draw>
Points with_noise(const Points& exact, std::uint64_t seed, const Draw& draw) {
    Random random(seed);
    Points points = exact;
    for (auto point : points.colwise()) {
        for (double& x : point) x += draw(random);
    }
    return points;
}

}  // namespace

Points with_even_noise(const Points& exact, double sigma) {
    const double half = std::sqrt(3.0) * sigma;
    return with_noise(exact, 12, [&](Random& random) { return random.uniform(-half, half); });
}

Points with_long_tails(const Points& exact, double sigma) {
    return with_noise(exact, 13, [&](Random& random) {
        const double exponential = -std::log(1 - random.uniform()) * sigma / std::sqrt(2.0);
        return random.uniform() < 0.5 ? exponential : -exponential;
    });
}

Points with_noise_along_z(const Points& exact, double sigma) {
    Random random(14);
    Points points = exact;
    for (double& z : points.row(2)) z += sigma * random.normal();
    return points;
}

Points rounded(const Points& exact, double step) {
    std::set<std::array<double, 3>> places;
    const Points steps = (exact / step).array().round().matrix();
    for (const auto place : steps.colwise()) places.insert({place.x(), place.y(), place.z()});
    Points unique(3, static_cast<Eigen::Index>(places.size()));
    Eigen::Index i = 0;
    for (const auto& place : places) unique.col(i++) = step * Eigen::Vector3d(place.data());
    return unique;
}

UnevenScan with_uneven_noise(const Points& exact, double least) {
    const double low = exact.row(0).minCoeff();
    const double extent = exact.row(0).maxCoeff() - low;
    Random random(11);
    UnevenScan scan{exact, {}};
    for (auto point : scan.points.colwise()) {
        const double noise = least * std::pow(8.0, (point.x() - low) / extent);
        scan.noise.push_back(noise);
        point += noise * Vector3d(random.normal(), random.normal(), random.normal());
    }
    return scan;
}

}  // namespace lpf::test
