#include "tests/paper/fandisk.h"

#include "tests/support/meshes.h"

namespace lpf::paper {
namespace {

constexpr int kPlacesOnAnEdge = 5;

Points places_along(const Points& vertices, const Triangles& edges) {
    Points places(3, kPlacesOnAnEdge * edges.cols());
    for (Eigen::Index i = 0; i < edges.cols(); ++i) {
        for (int k = 0; k < kPlacesOnAnEdge; ++k) {
            const double t = (k + 0.5) / kPlacesOnAnEdge;
            places.col(kPlacesOnAnEdge * i + k) =
                (1 - t) * vertices.col(edges(0, i)) + t * vertices.col(edges(1, i));
        }
    }
    return places;
}

}  // namespace

std::vector<std::uint8_t> FandiskBody::near_edges(const Points& points, double reach) const {
    std::vector<std::uint8_t> near;
    for (const double distance : test::distances_of(points, to_edges)) {
        near.push_back(distance < reach);
    }
    return near;
}

FandiskBody fandisk_body(const Settings& settings) {
    const Shape mesh = settings.fandisk ? *settings.fandisk : test::disk_segment_mesh();
    const Triangles edges = test::sharp_edges(mesh);
    return {mesh,
            settings.fandisk
                ? "The paper's Fandisk mesh, given to the command as a file (`--fandisk`)."
                : "The paper's Fandisk mesh is not part of the project and was not given "
                  "(`--fandisk FILE`). In its place stands a sector of a turned disk with steps, a "
                  "groove, a fillet and sharp rims, made here with the same diagonal.",
            test::MeshDistance(mesh.cloud.points, edges), places_along(mesh.cloud.points, edges)};
}

}  // namespace lpf::paper
