#include <cmath>
#include <numbers>
#include <utility>

#include "tests/support/meshes.h"
#include "tests/support/shapes.h"

namespace lpf::test {

TestShape make_from_mesh(std::string name, const Shape& mesh, const Sampling& sampling) {
    return sampled({std::move(name), {mesh_surface(mesh)}}, sampling);
}

TestShape make_pyramid(const Sampling& sampling) {
    const Shape mesh = pyramid_mesh();
    TestShape shape{"pyramid", {mesh_surface(mesh)}};
    for (int k = 0; k < 4; ++k) {  // the first four vertices are the base
        shape.borders.push_back(
            segment(mesh.cloud.points.col(k), mesh.cloud.points.col((k + 1) % 4)));
    }
    return sampled(std::move(shape), sampling);
}

TestShape make_disk_segment(const Sampling& sampling) {
    return make_from_mesh("disk_segment", disk_segment_mesh(), sampling);
}

TestShape make_head(const Sampling& sampling) {
    return make_from_mesh("head", head_mesh(), sampling);
}

TestShape make_shutter(const Sampling& sampling) {
    constexpr double kWide = 1.0, kTall = 1.8, kRim = 0.1, kDeep = 0.06;
    constexpr int kSlats = 24;
    const double inner = kTall - 2 * kRim, length = kWide - 2 * kRim;
    const Vector3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    TestShape shape{"shutter",
                    {rectangle({0, 0, 0}, kRim * x, kTall * z),
                     rectangle({kWide - kRim, 0, 0}, kRim * x, kTall * z),
                     rectangle({kRim, 0, 0}, length * x, kRim * z),
                     rectangle({kRim, 0, kTall - kRim}, length * x, kRim * z),
                     rectangle({kRim, 0, kRim}, kDeep * y, inner * z),
                     rectangle({kWide - kRim, 0, kRim}, kDeep * y, inner * z),
                     rectangle({kRim, 0, kRim}, length * x, kDeep * y),
                     rectangle({kRim, 0, kTall - kRim}, length * x, kDeep * y)}};
    const double pitch = inner / kSlats, tilt = 40 * std::numbers::pi / 180;
    const Vector3d across = 0.9 * pitch * (std::cos(tilt) * y + std::sin(tilt) * z);
    for (int i = 0; i < kSlats; ++i) {
        const Vector3d corner(kRim, 0.005, kRim + pitch * (i + 0.2));
        shape.pieces.push_back(rectangle(corner, length * x, across));
        shape.borders.push_back(segment(corner, corner + length * x));
        shape.borders.push_back(segment(corner + across, corner + across + length * x));
    }
    return sampled(std::move(shape), sampling);
}

}  // namespace lpf::test
