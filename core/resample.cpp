#include "core/resample.h"

#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/consolidation.h"
#include "core/field_set.h"
#include "core/nearest_sources.h"

namespace lpf {
namespace {

void validate(const ResampleParams& params) {
    validate(params.analysis);
    if ((params.target_spacing > 0) == (params.target_points > 0)) {
        throw Error(ErrorCode::InvalidParameter,
                    "Resampling needs either a target spacing or a target number of points.",
                    "targetSpacing");
    }
    if (!(params.detail >= 0 && params.detail <= 1)) {
        throw Error(ErrorCode::InvalidParameter, "The share of detail must be 0 to 1.", "detail");
    }
}

/// The analysis and the points that its LPFs agreed on. What the LPFs needed is gone by then.
struct Resampled {
    Consolidation::Found found;
    AnalysisResult analysis;
};

Resampled consolidate(const Shape& shape, const ResampleParams& params,
                      const Execution& execution) {
    FieldSet fields(shape, params.analysis, part_of(execution, 0.0, 0.02));
    fields.optimise_poses(params.analysis.pose_iterations, part_of(execution, 0.02, 0.1));
    AnalysisResult analysis = analyze(fields, params.analysis, part_of(execution, 0.1, 0.5));
    Consolidation consolidation(fields, analysis, params);
    const Execution rest = part_of(execution, 0.5, 1.0);
    Consolidation::Found found = params.target_points > 0
                                     ? consolidation.with_count(rest)
                                     : consolidation.with_spacing(params.target_spacing, rest);
    return {std::move(found), std::move(analysis)};
}

}  // namespace

ResampleResult resample(const Shape& shape, const ResampleParams& params,
                        const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points);
    const double denoised = params.denoise ? 0.4 : 0.0;
    std::optional<Shape> smooth;
    if (params.denoise) {
        smooth.emplace();
        smooth->triangles = shape.triangles;
        smooth->cloud.points =
            denoise(shape, *params.denoise, part_of(execution, 0.0, denoised)).points;
    }
    const Execution rest = part_of(execution, denoised, 1.0);
    Resampled done = consolidate(smooth ? *smooth : shape, params, part_of(rest, 0.0, 0.9));
    smooth.reset();

    Candidates points = done.found.consensus.take();
    ResampleResult result{std::move(points.points),
                          {},
                          std::move(points.field),
                          done.found.spacing,
                          std::move(done.analysis)};
    result.source = nearest_sources(shape.cloud.points, result.points, part_of(rest, 0.9, 1.0));
    return result;
}

}  // namespace lpf
