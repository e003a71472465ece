#include "tests/bench/accuracy/resampling.h"

#include <cmath>

#include "core/auto_parameters.h"
#include "tests/support/metrics.h"
#include "tests/support/shapes.h"

namespace lpf::accuracy {
namespace {

struct Resampled {
    Points points;
    double spacing;
};

Resampled resampled(const Points& points, std::size_t count, const Conditions& conditions) {
    const Presentation& presentation = conditions.presentation;
    const Shape shape{{presentation.placed(points), {}}, {}};
    const Measurements measured = measure(shape.cloud.points, conditions.execution);
    ParameterRequest request;
    request.target_points = count;
    request.random_seed = presentation.random_seed;
    const ResampleParams params =
        resolve_parameters(Task::Resample, shape, measured, request).resample;
    const ResampleResult result = resample(shape, params, conditions.execution);
    return {presentation.placed_back(result.points), presentation.length_before(result.spacing)};
}

}  // namespace

Case resampling_case() {
    return {"resampling", "80 000 points on a cube with a curve, noise .01, to 360 000 points",
            [](const Conditions& conditions) {
                constexpr std::size_t kWanted = 360000;
                const test::TestShape shape = test::make_cube_with_curve(
                    {.points = 80000, .noise = 0.01, .seed = conditions.seed});
                const Resampled result = resampled(shape.points, kWanted, conditions);
                const auto errors = test::error_by_part(result.points, shape, 0.03);
                const auto covered = test::coverage_of_shape(shape, result.points);
                const auto spacing = test::nearest_neighbour_stats(result.points);
                const double count = static_cast<double>(result.points.cols());
                return std::vector<Figure>{
                    {"RMSE", errors.all.rmse, 0.003},
                    {"of the curve", errors.curve.rmse, 0.003},
                    {"coverage of surfaces", covered.surface, 0.008},
                    {"coverage of curves", covered.curve, 0.008},
                    {"variation of the spacing", spacing.deviation / spacing.mean, 0.15},
                    {"farthest point", errors.all.max, result.spacing},
                    {"count off by", std::abs(count / kWanted - 1), 0.02}};
            }};
}

}  // namespace lpf::accuracy
