#include "tests/paper/errors.h"
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
    std::vector<test::Scene> noisy, denoised;
    const test::View view = test::fit_view(body.mesh.cloud.points, 120, 35, 1.3);
    for (const double share : {0.01, 0.015, 0.02}) {
        const TestShape shape =
            test::make_from_mesh("fandisk", body.mesh,
                                 {.points = settings.points(600000),
                                  .noise = share * test::diagonal_of(body.mesh.cloud.points),
                                  .seed = 17});
        const std::vector<std::uint8_t> flags = body.near_edges(shape.clean, 0.2);
        const auto near = [&](Eigen::Index i) { return flags[std::size_t(i)] != 0; };
        const Denoised done = denoise_with(shape.points, {}, settings);
        const Denoised theirs = denoise_with(shape.points, paper_request(0.2, 193, 8), settings);
        const Errors before(shape.points, shape), after(done.points, shape),
            by_paper(theirs.points, shape);
        const std::string name = percent(share, 2).text;
        section.tables[0].rows.push_back({name, number(before.rmse()), number(after.rmse()),
                                          number(before.rmse_of(near)), number(after.rmse_of(near)),
                                          number(done.radius), number(done.seconds, 2),
                                          number(by_paper.rmse()), number(by_paper.rmse_of(near))});
        better &= after.rmse() < before.rmse() / 3;
        better_near_edges &= after.rmse_of(near) < before.rmse_of(near) / 2;
        if (settings.picture_folder.empty()) continue;
        noisy.push_back(plain_scene(shape.points, name, view));
        denoised.push_back(plain_scene(done.points, "", view));
    }
    section.claims = {
        {"noise is removed at each level: the error falls to less than a third", better},
        {"features are preserved: near sharp edges it falls to less than half", better_near_edges}};
    add_picture(section, settings, "fandisk-denoised", "Input and result at the three levels.",
                [&] {
                    return below_each_other({render_side_by_side(noisy, view, {900, 220}),
                                             render_side_by_side(denoised, view, {900, 220})});
                });
    return section;
}

}  // namespace lpf::paper
