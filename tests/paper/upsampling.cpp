#include "tests/paper/errors.h"
#include "tests/paper/experiments.h"
#include "tests/support/metrics.h"

namespace lpf::paper {

namespace {

/// Resamples a shape to a number of points. Its table goes into the section: a row for the shape as
/// it is scanned and one as it is resampled, with errors and coverage.
Resampled upsample(Section& section, const TestShape& shape, ParameterRequest request,
                   std::size_t target, const Settings& settings) {
    request.target_points = target;
    const Resampled done = resample_with(cloud_of(shape.points), request, settings);
    Table table{{"points", "count", "RMSE", "95 % of errors below", "coverage of surfaces",
                 "of curves", "of borders", "seconds"}};
    const auto add = [&](const std::string& name, const Resampled& each) {
        const auto coverage = test::coverage_of_shape(shape, each.points);
        const test::ErrorStats all = Errors(each.points, shape).all();
        table.rows.push_back({name, number(double(each.points.cols()), 1), number(all.rmse),
                              number(all.p95), number(coverage.surface), number(coverage.curve),
                              number(coverage.border), number(each.seconds, 2)});
    };
    add("input", {shape.points});
    add("resampled", done);
    section.tables = {std::move(table)};
    return done;
}

Claim noise_falls(const Table& table, const std::string& share, double divisor) {
    return {"noise is taken out: the error falls to less than " + share,
            table.at("resampled", "RMSE") < table.at("input", "RMSE") / divisor};
}

}  // namespace

Section ship(const Settings& settings) {
    Section section{
        .title = "Fig. 1: a ship with its rigging, twice as dense",
        .paper =
            "A LiDAR scan of 1.1 million points becomes 2.2 million. Curves and surfaces are "
            "both kept, whereas EAR enlarges curves and anisotropic MLS blurs. Shown as "
            "pictures, without numbers.",
        .here =
            "That scan is not to be had: the surface under a net of curves of Table 1 with "
            "1.1 million points and noise of .05. Nothing is given but the number of points."};
    const TestShape shape =
        test::make_curvenet({.points = settings.points(1100000), .noise = 0.05, .seed = 1});
    const Resampled done = upsample(section, shape, {}, settings.points(2200000), settings);
    const Table& table = section.tables[0];
    section.claims = {
        noise_falls(table, "a third", 3),
        {"curves are covered no worse than the surface is in the input",
         table.at("resampled", "of curves") < table.at("input", "coverage of surfaces")}};
    add_picture(section, settings, "ship", "A part: input and result.", [&] {
        const test::View view{
            .azimuth = -60, .elevation = 25, .centre = {8, -8, 2.5}, .extent = 11};
        return plain_pair(shape, done.points, view, {800, 330});
    });
    return section;
}

Section facade(const Settings& settings) {
    Section section{
        .title = "Fig. 12: an open scan with borders, eleven times as dense",
        .paper =
            "200 000 points of the Trianon facade become 2.2 million; r = .003, M = 193, "
            "d = 32, diagonal 1.36: .22 % of the diagonal. Details are enhanced and borders "
            "kept. Shown as pictures, without numbers.",
        .here =
            "That scan is not to be had: an open wavy sheet of 4 x 4 with 200 000 points and "
            "noise of .003, of which borders and surface are known exactly. The paper's M, d, "
            "lambda and iterations; relative to the diagonal its radius would hold too few "
            "points of this sheet, so the radius is automatic."};
    const TestShape shape =
        test::make_open_sheet({.points = settings.points(200000), .noise = 0.003, .seed = 12});
    ParameterRequest request = paper_request(1.0, 193, 32);
    request.radius.reset();
    upsample(section, shape, request, settings.points(2200000), settings);
    const Table& table = section.tables[0];
    section.claims = {noise_falls(table, "a third", 3),
                      {"borders are kept: they are covered no worse than by the input",
                       table.at("resampled", "of borders") <= table.at("input", "of borders")}};
    return section;
}

Section mire(const Settings& settings) {
    Section section{
        .title = "Fig. 13: an uneven scan, resampled with as many points",
        .paper =
            "15 million points of a calibration target are resampled to as many; r = .4, "
            "M = 193, d = 64, diagonal 285.35. The noise is removed and the sampling "
            "regularised. Shown as pictures, without numbers.",
        .here =
            "That scan is not to be had, and 15 million points are left out for the time that "
            "they take: a square of 2 x 2, four times as dense on its left half, with 1 "
            "million points and noise of .002. Nothing is given but the number of points."};
    const TestShape shape =
        test::make_density_step({.points = settings.points(1000000), .noise = 0.002, .seed = 13});
    const Resampled done = upsample(section, shape, {}, settings.points(1000000), settings);
    section.tables.push_back({{"points", "mean neighbour distance", "variation"}});
    const auto add = [&](const std::string& name, const Points& points) {
        const auto gaps = test::nearest_neighbour_stats(points);
        section.tables[1].rows.push_back(
            {name, number(gaps.mean), number(gaps.deviation / gaps.mean, 2)});
    };
    add("input", shape.points);
    add("resampled", done.points);
    const Table& table = section.tables[0];
    section.claims = {
        noise_falls(table, "a third", 3),
        {"the sampling is regularised: neighbour distances vary less than half as much",
         section.tables[1].at("resampled", "variation") <
             section.tables[1].at("input", "variation") / 2}};
    return section;
}

Section shutter(const Settings& settings) {
    Section section{
        .title = "Fig. 14: a shutter",
        .paper =
            "290 000 scanned points become 2.0 million; r = .02, M = 193, d = 64, diagonal "
            "2.07. Shown reconstructed by Screened Poisson, without numbers: sharp edges are "
            "enhanced.",
        .here =
            "That scan is not to be had: a frame around 24 tilted slats, all open sheets, with "
            "the same diagonal and number of points and noise of .001. The paper's r, M, d, "
            "lambda and iterations."};
    const TestShape shape =
        test::make_shutter({.points = settings.points(290000), .noise = 0.001, .seed = 14});
    const Resampled done =
        upsample(section, shape, paper_request(0.02, 193, 64), settings.points(2000000), settings);
    const Table& table = section.tables[0];
    section.claims = {noise_falls(table, "half", 2),
                      {"edges of the slats are kept: they are covered no worse than by the input",
                       table.at("resampled", "of borders") <= table.at("input", "of borders")}};
    add_picture(section, settings, "shutter", "A corner of the shutter: input and result.", [&] {
        const test::View view{
            .azimuth = 240, .elevation = 20, .centre = {0.2, 0, 0.3}, .extent = 0.5};
        return plain_pair(shape, done.points, view, {900, 400});
    });
    return section;
}

}  // namespace lpf::paper
