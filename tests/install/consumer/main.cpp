// Denoises a sphere, and tells whether it became rounder.
#include <cmath>
#include <iostream>

#include "core/auto_parameters.h"
#include "core/base/random.h"
#include "core/denoise.h"

namespace {

lpf::Shape noisy_sphere(int points) {
    lpf::Random random(1);
    lpf::Shape shape;
    shape.cloud.points.resize(3, points);
    for (int i = 0; i < points; ++i) {
        const double z = random.uniform(-1, 1);
        const double angle = random.uniform(0, 2 * M_PI);
        const double flat = std::sqrt(1 - z * z);
        const double radius = 1 + random.uniform(-0.03, 0.03);
        shape.cloud.points.col(i) =
            radius * Eigen::Vector3d(flat * std::cos(angle), flat * std::sin(angle), z);
    }
    return shape;
}

double error(const lpf::Points& points) {
    return std::sqrt((points.colwise().norm().array() - 1).square().mean());
}

}  // namespace

int main() {
    const lpf::Shape shape = noisy_sphere(3000);
    const lpf::Measurements measured = lpf::measure(shape.cloud.points, {});
    const auto parameters = lpf::resolve_parameters(lpf::Task::Denoise, shape, measured, {});
    const lpf::DenoiseResult result = lpf::denoise(shape, parameters.denoise, {});
    const double before = error(shape.cloud.points);
    const double after = error(result.points);
    std::cout << "error " << before << " -> " << after << "\n";
    return after < 0.7 * before ? 0 : 1;
}
