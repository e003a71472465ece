#include "tests/bench/accuracy/denoising.h"

#include <cmath>
#include <limits>

#include "tests/bench/accuracy/denoised.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf::accuracy {
namespace {

using test::TestShape;
using test::Vector3d;

/// "Near edges" is within so many standard deviations of the noise.
constexpr double kSigmasNearEdges = 3.0;

double rmse(const Points& points, const TestShape& shape) {
    return test::error_to_shape(points, shape).rmse;
}

Case curvenet(const std::string& name, double noise, double error, double curves) {
    return {name, "400 000 points, noise " + name, [=](const Conditions& conditions) {
                const TestShape shape = test::make_curvenet(
                    {.points = 400000, .noise = noise, .seed = conditions.seed});
                const Points result = denoised(shape.points, conditions);
                const auto before = test::coverage_of_shape(shape, shape.points);
                const auto after = test::coverage_of_shape(shape, result);
                return std::vector<Figure>{{"RMSE", rmse(result, shape), error},
                                           {"coverage of curves", after.curve, curves},
                                           {"coverage of the border", after.border, before.border}};
            }};
}

Case cube() {
    return {"cube", "150 000 points, noise .05", [](const Conditions& conditions) {
                constexpr double kNoise = 0.05;
                const TestShape shape =
                    test::make_cube({.points = 150000, .noise = kNoise, .seed = conditions.seed});
                const auto errors = test::error_by_part(denoised(shape.points, conditions), shape,
                                                        kSigmasNearEdges * kNoise);
                return std::vector<Figure>{{"RMSE", errors.all.rmse, 0.006},
                                           {"near edges", errors.near_edges.rmse, 0.010}};
            }};
}

Case cube_with_curve() {
    return {"cube-with-curve", "80 000 points, noise .01", [](const Conditions& conditions) {
                const TestShape shape = test::make_cube_with_curve(
                    {.points = 80000, .noise = 0.01, .seed = conditions.seed});
                const Points result = denoised(shape.points, conditions);
                return std::vector<Figure>{{"RMSE", rmse(result, shape), 0.003}};
            }};
}

Case fandisk(const std::string& name, double percent, double error) {
    return {name, "600 000 points, noise of so many per cent of the diagonal",
            [=](const Conditions& conditions) {
                if (!conditions.fandisk) return std::vector<Figure>{};
                const double diagonal = test::diagonal_of(conditions.fandisk->cloud.points);
                const TestShape shape = test::make_from_mesh(
                    name, *conditions.fandisk,
                    {.points = 600000, .noise = percent / 100 * diagonal, .seed = conditions.seed});
                const Points result = denoised(shape.points, conditions);
                return std::vector<Figure>{{"RMSE", rmse(result, shape), error}};
            }};
}

/// Thin parts, each with about 10 000 points a unit of area, so that 150 points fill a disk of
/// .069, and noise of a tenth of that.
constexpr double kRadius = 0.069;

Case thin(const std::string& name, const std::string& what, double noise, std::size_t points,
          const std::function<TestShape(const test::Sampling&)>& make) {
    return {name, what, [=](const Conditions& conditions) {
                const TestShape shape =
                    make({.points = points, .noise = noise, .seed = conditions.seed});
                const Points result = denoised(shape.points, conditions);
                std::vector<Figure> figures{{"RMSE", rmse(result, shape), noise / 2}};
                const auto before = test::coverage_of_shape(shape, shape.points);
                const auto after = test::coverage_of_shape(shape, result);
                figures.push_back({"coverage of surfaces", after.surface, before.surface});
                if (std::isfinite(after.curve)) {
                    figures.push_back({"coverage of curves", after.curve, before.curve});
                }
                return figures;
            }};
}

TestShape make_wires_near_a_wall(const test::Sampling& sampling) {
    TestShape shape{"wires", {test::rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0})}};
    for (const double y : {-0.5, 0.0, 0.5}) {
        const Vector3d start(-0.9, y, kRadius / 2);
        shape.pieces.push_back(test::segment(start, start + Vector3d(1.8, 0, 0)));
    }
    return test::sampled(std::move(shape), sampling);
}

/// Mean squared distance from the points to the exact shape, and from the shape to the points.
double both_ways(const TestShape& shape, const Points& points) {
    return std::pow(rmse(points, shape), 2) +
           std::pow(test::coverage_of_shape(shape, points).surface, 2);
}

Case small_bodies() {
    return {"small-bodies",
            "ten bodies of 10 000 points, noise as large as their spacing: what is left of the "
            "mean squared distance both ways",
            [](const Conditions& conditions) {
                std::vector<Figure> figures{{"mean", 0.0, 0.65}};
                for (const TestShape& body : test::make_small_bodies(conditions.seed)) {
                    const Points result = denoised(body.points, conditions);
                    const double left = both_ways(body, result) / both_ways(body, body.points);
                    figures[0].value += left / 10;
                    figures.push_back({body.name, left, 1.0});
                }
                return figures;
            }};
}

}  // namespace

std::vector<Case> denoising_cases() {
    return {curvenet("curvenet-.124", 0.124, 0.009, 0.02),
            curvenet("curvenet-.25", 0.25, 0.018, 0.04),
            curvenet("curvenet-.38", 0.38, 0.034, 0.07),
            cube(),
            cube_with_curve(),
            fandisk("fandisk-1%", 1.0, 0.010),
            fandisk("fandisk-1.5%", 1.5, 0.016),
            fandisk("fandisk-2%", 2.0, 0.024),
            thin("plate", "80 000 points on two sheets 4 sigma apart", 0.1 * kRadius, 80000,
                 [](const test::Sampling& s) { return test::make_thin_plate(s, 0.4 * kRadius); }),
            thin("fin", "40 000 points on two sheets at 15 degrees", 0.1 * kRadius, 40000,
                 [](const test::Sampling& s) { return test::make_fin(s, 15); }),
            thin("wires", "40 000 points on wires 5 sigma above a wall", 0.1 * kRadius, 40000,
                 make_wires_near_a_wall),
            small_bodies()};
}

}  // namespace lpf::accuracy
