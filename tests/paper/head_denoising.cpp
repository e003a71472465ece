#include "tests/paper/errors.h"
#include "tests/paper/experiments.h"

namespace lpf::paper {

Section head_denoising(const Settings& settings) {
    const TestShape shape =
        test::make_head({.points = settings.points(200000), .noise = 0.004 * 51.96, .seed = 19});
    Section section{
        .title = "Fig. 19: denoising a head",
        .paper =
            "The Brassempouy scan with added noise of .4 % of the diagonal of 51.96; r = .7, "
            "M = 193, d = 32. Shown beside other methods, without numbers: no low-frequency "
            "artefacts.",
        .here =
            "The head of Fig. 6 with 200 000 points and Gaussian noise of .4 % of the diagonal "
            "in each coordinate.",
        .tables = {
            {{"points", "RMSE", "95 % of errors below", "largest error", "radius", "seconds"}}}};
    const auto row_of = [&](const std::string& name, const Denoised& done) -> std::vector<Cell> {
        const test::ErrorStats all = Errors(done.points, shape).all();
        return {name,
                number(all.rmse),
                number(all.p95),
                number(all.max),
                number(done.radius),
                number(done.seconds, 2)};
    };
    const Denoised automatic = denoise_with(shape.points, {}, settings);
    Table& table = section.tables[0];
    table.rows = {row_of("input", {shape.points}), row_of("automatic", automatic),
                  row_of("paper's parameters",
                         denoise_with(shape.points, paper_request(0.7, 193, 32), settings))};
    section.claims = {{"the noise falls to less than a third",
                       table.at("automatic", "RMSE") < table.at("input", "RMSE") / 3}};
    add_picture(section, settings, "head-denoised", "Noisy, denoised, and the exact shape.", [&] {
        const test::View view = test::fit_view(shape.clean, 40, 12, 0.8);
        return render_side_by_side(
            {plain_scene(shape.points, "noisy", view), plain_scene(automatic.points, "LPF", view),
             plain_scene(shape.clean, "exact", view)},
            view, {900, 380});
    });
    return section;
}

}  // namespace lpf::paper
