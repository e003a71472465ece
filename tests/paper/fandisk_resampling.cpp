#include "tests/paper/errors.h"
#include "tests/paper/experiments.h"
#include "tests/paper/fandisk.h"

namespace lpf::paper {
namespace {

constexpr double kNear = 0.02;  // of an edge, about three spacings of a million points

std::vector<Cell> row_of(const std::string& name, const FandiskBody& body, const TestShape& exact,
                         const Resampled& done) {
    const double diagonal = exact.diagonal();
    const Errors errors(done.points, exact);
    const auto near = [&](Eigen::Index i) { return body.to_edges(done.points.col(i)) < kNear; };
    return {name,
            number(double(done.points.cols()), 1),
            number(100 * errors.rmse() / diagonal),
            number(100 * errors.all().max / diagonal),
            number(100 * errors.rmse_of(near) / diagonal),
            number(100 * test::coverage(body.on_edges, done.points) / diagonal),
            number(100 * done.spacing / diagonal),
            number(done.seconds, 2)};
}

}  // namespace

Section fandisk_resampling(const Settings& settings) {
    const FandiskBody body = fandisk_body(settings);
    const TestShape exact = test::make_from_mesh("fandisk", body.mesh, {.points = 1});
    Section section{
        .title = "Fig. 11: the Fandisk mesh to a million points",
        .paper =
            "The mesh (6 000 vertices) becomes 1 million points; r = .2, M = 793, d = 16, "
            "diagonal 7.61. Shown as a picture, without numbers.",
        .here = body.what +
                " The paper's r, M, d, lambda and iterations. `consolidated` takes the "
                "points from the dictionary alone, as the paper does; `followed` is "
                "what the program does with meshes: it adds what the codes leave out.",
        .tables = {{{"% of the diagonal", "count", "RMSE", "largest error", "RMSE near sharp edges",
                     "coverage of sharp edges", "spacing", "seconds"}}}};
    ParameterRequest request = paper_request(0.2, 793, 16);
    request.target_points = settings.points(1000000);
    const Resampled consolidated =
        resample_with(body.mesh, request, settings, [](ResampleParams& p) { p.detail = 0.0; });
    const Resampled followed = resample_with(body.mesh, request, settings);
    Table& table = section.tables[0];
    table.rows = {row_of("consolidated", body, exact, consolidated),
                  row_of("followed", body, exact, followed)};
    section.claims = {
        {"the resampling is accurate: no point is farther from the mesh than one spacing",
         table.at("followed", "largest error") < table.at("followed", "spacing")},
        {"edges stay sharp: they are covered within one spacing",
         table.at("followed", "coverage of sharp edges") < table.at("followed", "spacing")}};
    add_picture(section, settings, "fandisk-resampled",
                "The vertices of the mesh, and the points that follow it.", [&] {
                    const test::View view = test::fit_view(body.mesh.cloud.points, 120, 35, 1.2);
                    return render_side_by_side(
                        {plain_scene(body.mesh.cloud.points, "vertices", view),
                         plain_scene(followed.points, "resampled", view)},
                        view, {900, 380});
                });
    return section;
}

}  // namespace lpf::paper
