#include "tests/paper/experiments.h"
#include "tests/paper/fandisk.h"

namespace lpf::paper {

Section fandisk_denoising(const Settings& settings) {
    const FandiskBody body = fandisk_body(settings);
    Section section{.title = "Fig. 17: denoising the Fandisk at three levels of noise",
                    .paper =
                        "600 000 points, noise of 1, 1.5 and 2 % of the diagonal of 7.61; r = .2, "
                        "M = 193, d = 8. Shown as pictures, without numbers.",
                    .here = body.what +
                            " 600 000 points uniform by area, Gaussian noise in each coordinate; "
                            "RMS distances to the exact mesh. Automatic parameters, and beside "
                            "them the paper's r, M, d, lambda and iterations. `Near edges` are the "
                            "points that were drawn within .2 of a sharp edge.",
                    .tables = {{{"noise", "RMSE, input", "RMSE, automatic", "near edges, input",
                                 "near edges, automatic", "radius", "seconds",
                                 "RMSE, paper's parameters", "near edges, paper's parameters"}}}};
    bool better = true, better_near_edges = true;
    std::vector<test::Image> rows;
    for (const double share : {0.01, 0.015, 0.02}) {
        const TestShape shape =
            test::make_from_mesh("fandisk", body.mesh,
                                 {.points = settings.points(600000),
                                  .noise = share * test::diagonal_of(body.mesh.cloud.points),
                                  .seed = 17});
        const auto near = body.near_edges(shape.clean, 0.2);
        const auto error = [&](const Points& points, const std::vector<std::uint8_t>& use) {
            return test::error_to_shape(points, shape, use).rmse;
        };
        const Denoised done = denoise_with(shape.points, {}, settings);
        const Denoised theirs = denoise_with(shape.points, paper_request(0.2, 193, 8), settings);
        section.tables[0].rows.push_back(
            {percent(share, 2).text, number(error(shape.points, {})),
             number(error(done.points, {})), number(error(shape.points, near)),
             number(error(done.points, near)), number(done.radius), number(done.seconds, 2),
             number(error(theirs.points, {})), number(error(theirs.points, near))});
        better &= error(done.points, {}) < error(shape.points, {}) / 3;
        better_near_edges &= error(done.points, near) < error(shape.points, near) / 2;
        if (settings.picture_folder.empty()) continue;
        const test::View view = test::fit_view(body.mesh.cloud.points, 120, 35, 1.0);
        rows.push_back(render_side_by_side(
            {plain_scene(shape.points, section.tables[0].rows.back()[0].text, view),
             plain_scene(done.points, "LPF", view)},
            view, {330, 160}));
    }
    section.claims = {
        {"noise is removed at each level: the error falls to less than a third", better},
        {"features are preserved: near sharp edges it falls to less than half", better_near_edges}};
    add_picture(section, settings, "fandisk-denoised", "Input and result at the three levels.",
                [&] { return beside_each_other(rows); });
    return section;
}

}  // namespace lpf::paper
