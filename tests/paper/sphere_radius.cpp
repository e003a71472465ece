#include <cmath>

#include "tests/paper/errors.h"
#include "tests/paper/experiments.h"
#include "tests/support/meshes.h"

namespace lpf::paper {

Section sphere_radius(const Settings& settings) {
    Section section{
        .title = "Fig. 10: a sphere of 100 vertices, small and large radius",
        .paper =
            "A mesh of a sphere with 100 vertices is resampled from dictionaries of 16 atoms. "
            "With a small radius it stays a piecewise linear shape, with a large one it is "
            "interpreted as a sphere. The radii are not stated.",
        .here =
            "A sphere of radius 1 by latitude and longitude with exactly 100 vertices, "
            "resampled to 40 000 points from the dictionary alone (nothing of what the codes "
            "leave out is put back). Distances to the facets, and to the sphere around the same "
            "centre that fits best.",
        .tables = {{{"radius", "RMSE to the facets", "RMSE to a sphere", "count", "seconds"}}}};
    const Shape mesh = test::globe(1.0, 7, 14);
    const TestShape facets = test::make_from_mesh("facets", mesh, {.points = 1});
    std::vector<Points> results;
    for (const double radius : {0.1, 0.4}) {
        ParameterRequest request = paper_request(radius, 193, 16);
        request.target_points = settings.points(40000);
        const Resampled done =
            resample_with(mesh, request, settings, [](ResampleParams& p) { p.detail = 0.0; });
        // Around the mean reach, so that only the form counts.
        const Eigen::VectorXd reach = done.points.colwise().norm();
        const double to_sphere = std::sqrt((reach.array() - reach.mean()).square().mean());
        section.tables[0].rows.push_back(
            {number(radius, 2).text, number(Errors(done.points, facets).rmse()), number(to_sphere),
             number(double(done.points.cols()), 1), number(done.seconds, 2)});
        results.push_back(done.points);
    }
    const Table& table = section.tables[0];
    const std::string small = table.rows[0][0].text, large = table.rows[1][0].text;
    section.claims = {
        {"with the small radius the facets are followed",
         table.at(small, "RMSE to the facets") < table.at(small, "RMSE to a sphere") / 3},
        {"with the large radius the result is rounder than with the small one",
         table.at(large, "RMSE to a sphere") < table.at(small, "RMSE to a sphere")},
        {"with the large radius it is nearer to a sphere than to the facets",
         table.at(large, "RMSE to a sphere") < table.at(large, "RMSE to the facets")}};
    add_picture(section, settings, "sphere", "Small and large radius.", [&] {
        const test::View view{.azimuth = -60, .elevation = 30, .extent = 2.2};
        return render_side_by_side({plain_scene(results[0], "r = " + small, view),
                                    plain_scene(results[1], "r = " + large, view)},
                                   view, {800, 380});
    });
    return section;
}

}  // namespace lpf::paper
