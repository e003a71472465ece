#include <cmath>

#include "tests/paper/errors.h"
#include "tests/paper/experiments.h"

namespace lpf::paper {
namespace {

constexpr double kDiagonal = 9.08;
constexpr double kRadius = 0.2;

}  // namespace

Section cube_denoising(const Settings& settings) {
    const double half = kDiagonal / (2 * std::sqrt(3.0));
    const TestShape shape =
        test::make_cube({.points = settings.points(150000), .noise = 0.045, .seed = 18}, half);
    std::vector<std::uint8_t> near;
    for (Eigen::Index i = 0; i < shape.clean.cols(); ++i) {
        near.push_back(test::distance_to_pieces(shape.edges, shape.clean.col(i)) < kRadius);
    }
    Section section{
        .title = "Fig. 18: denoising a cube",
        .paper =
            "A noisy cube of diagonal 9.08; r = .2, M = 193, d = 3. Shown beside a bilateral "
            "filter with the same error on the faces, without numbers: LPF smooths the edge "
            "less.",
        .here =
            "150 000 points on a hollow cube of the same diagonal, noise of .045 (half a per "
            "cent of it) in each coordinate, as neither is stated. `Near edges` are the points "
            "that were drawn within .2 of an edge.",
        .tables = {{{"points", "RMSE", "near edges", "away from edges", "95 % of errors below",
                     "radius", "seconds"}}}};

    const auto row_of = [&](const std::string& name, const Denoised& done) -> std::vector<Cell> {
        const Errors errors(done.points, shape);
        const auto is_near = [&](Eigen::Index i) { return near[std::size_t(i)] != 0; };
        return {name,
                number(errors.rmse()),
                number(errors.rmse_of(is_near)),
                number(errors.rmse_of([&](Eigen::Index i) { return !is_near(i); })),
                number(errors.all().p95),
                number(done.radius),
                number(done.seconds, 2)};
    };
    const Denoised automatic = denoise_with(shape.points, {}, settings);
    Table& table = section.tables[0];
    table.rows = {row_of("input", {shape.points}), row_of("automatic", automatic),
                  row_of("paper's parameters",
                         denoise_with(shape.points, paper_request(kRadius, 193, 3), settings))};
    section.claims = {
        {"the faces are clean: away from edges the error falls to less than a fifth",
         table.at("automatic", "away from edges") < table.at("input", "away from edges") / 5},
        {"the edge is kept: near it the error falls to less than half",
         table.at("automatic", "near edges") < table.at("input", "near edges") / 2}};
    add_picture(
        section, settings, "cube-denoised",
        "A corner before and after, coloured by the distance to the exact cube (yellow: "
        ".09 and more).",
        [&] {
            const test::View view{.azimuth = 35,
                                  .elevation = 30,
                                  .centre = 0.8 * test::Vector3d::Constant(half),
                                  .extent = 2.4};
            return distance_pair(shape, automatic.points, 0.09, {"noisy", "LPF"}, view, {900, 380});
        });
    return section;
}

}  // namespace lpf::paper
