#include "tests/paper/errors.h"
#include "tests/paper/experiments.h"
#include "tests/support/metrics.h"

namespace lpf::paper {

Section pyramid(const Settings& settings) {
    Section section{
        .title = "Fig. 15: an engraved pyramid, sparsely sampled",
        .paper =
            "280 000 points of a pyramid with engravings become 2.2 million; r = .8, "
            "M = 793, d = 64, diagonal 125.51. Shown beside MLS and EAR, without numbers: "
            "the engravings are recovered.",
        .here =
            "A square pyramid of the same diagonal, with V-shaped and flat-floored engravings "
            ".5 to 2.5 wide and .3 to .6 deep; random points without noise, about .2 apart. "
            "The paper's r, M, d and lambda; 3 iterations, as 10 take minutes.",
        .tables = {{{"points", "count", "RMSE", "95 % of errors below", "largest error", "coverage",
                     "seconds"}}}};
    const TestShape shape = test::make_pyramid({.points = settings.points(280000), .seed = 15});
    ParameterRequest request = paper_request(0.8, 793, 64);
    request.analysis_iterations = 3;
    request.target_points = settings.points(2200000);
    const Resampled done = resample_with(cloud_of(shape.points), request, settings);
    const auto row_of = [&](const std::string& name, const Resampled& each) -> std::vector<Cell> {
        const Points& points = each.points;
        const test::ErrorStats all = Errors(points, shape).all();
        return {name,
                number(double(points.cols()), 1),
                number(all.rmse),
                number(all.p95),
                number(all.max),
                number(test::coverage_of_shape(shape, points).surface),
                number(each.seconds, 2)};
    };
    section.tables[0].rows = {row_of("input", {shape.points}), row_of("resampled", done)};
    const Table& table = section.tables[0];
    section.claims = {
        {"the engravings are recovered: the error is below a tenth of the shallowest's depth",
         table.at("resampled", "RMSE") < 0.03},
        {"the shape is covered more densely: to less than half the input's distance",
         table.at("resampled", "coverage") < table.at("input", "coverage") / 2}};
    add_picture(section, settings, "pyramid", "A part of one side: input and result.", [&] {
        const test::View view{
            .azimuth = -60, .elevation = 20, .centre = {10, -26, 20}, .extent = 18};
        return plain_pair(shape, done.points, view, {900, 400});
    });
    return section;
}

}  // namespace lpf::paper
