#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/shape/point_cloud.h"
#include "tests/support/image.h"

namespace lpf::test {

/// Where a picture is taken from, and how much of the scene it shows. Parallel projection, z up.
struct View {
    double azimuth = -60.0;                            ///< degrees around z, from the x axis
    double elevation = 30.0;                           ///< degrees above the horizon
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< in the middle of the picture
    double extent = 1.0;  ///< length that the shorter side of the picture shows
};

/// A view of all points from the given direction.
[[nodiscard]] View fit_view(const Points& points, double azimuth, double elevation, double aspect);

/// Points as they are to be drawn. All the same number of columns.
struct Scene {
    Points points;
    Eigen::Matrix3Xf normals;  ///< unit; their sign does not matter
    std::vector<Colour> colours;
    std::string label = {};
};

struct PictureSize {
    int width = 800;
    int height = 600;
};

/// Draws points as discs about as large as their distance, lit from the camera's upper left, with
/// darker rims where depth jumps. Deterministic.
[[nodiscard]] Image render(const Scene& scene, const View& view, const PictureSize& size);

/// The scenes side by side, each with its label.
[[nodiscard]] Image render_side_by_side(const std::vector<Scene>& scenes, const View& view,
                                        const PictureSize& size);

}  // namespace lpf::test
