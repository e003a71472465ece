#include "server/work/computation.h"

#include <utility>

#include "core/base/error.h"

namespace lpf::server {
namespace {

Computation from(DenoiseResult result) {
    return {.points = std::move(result.points),
            .source = {},
            .rms_moves = std::move(result.rms_moves),
            .analysis = std::move(result.analysis)};
}

Computation from(ResampleResult result) {
    if (result.source.empty()) {
        throw Error(
            ErrorCode::DegenerateShape,
            "The fields agree on no point at all: the shape is too sparse for this radius.");
    }
    return {.points = std::move(result.points),
            .source = std::move(result.source),
            .rms_moves = {},
            .analysis = std::move(result.analysis)};
}

}  // namespace

Computation compute(Task task, const Shape& shape, const ResolvedParameters& parameters,
                    const Execution& execution) {
    switch (task) {
        case Task::Denoise: return from(denoise(shape, parameters.denoise, execution));
        case Task::Resample: return from(resample(shape, parameters.resample, execution));
        case Task::Analyze:
            return {.points = std::nullopt,
                    .source = {},
                    .rms_moves = {},
                    .analysis = analyze(shape, parameters.analysis, execution)};
    }
    throw Error(ErrorCode::Internal, "An unknown process was asked for.");
}

}  // namespace lpf::server
