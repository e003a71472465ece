#include "tests/bench/accuracy/denoised.h"

#include "core/auto_parameters.h"

namespace lpf::accuracy {

Points denoised(const Points& points, const Conditions& conditions) {
    const Presentation& presentation = conditions.presentation;
    const Shape shape{{presentation.placed(points), {}}, {}};
    const Measurements measured = measure(shape.cloud.points, conditions.execution);
    ParameterRequest request;
    request.random_seed = presentation.random_seed;
    const DenoiseParams params =
        resolve_parameters(Task::Denoise, shape, measured, request).denoise;
    return presentation.placed_back(denoise(shape, params, conditions.execution).points);
}

}  // namespace lpf::accuracy
