#include "core/resample.h"

#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/memory.h"
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

/// What is left of the shape without its noise; the shape itself where it has none.
std::optional<Shape> without_noise(const Shape& shape, const ResampleParams& params,
                                   const Execution& execution) {
    if (!params.denoise) return std::nullopt;
    return Shape{{denoise(shape, *params.denoise, execution).points, {}}, shape.triangles};
}

}  // namespace

ResampleResult resample(const Shape& shape, const ResampleParams& params,
                        const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points);
    const double denoised = params.denoise ? 0.4 : 0.0;
    std::optional<Shape> smooth = without_noise(shape, params, part_of(execution, 0.0, denoised));
    const Execution rest = part_of(execution, denoised, 1.0);
    std::optional<FieldSet> fields(std::in_place, smooth ? *smooth : shape, params.analysis,
                                   part_of(rest, 0.0, 0.02));
    // The LPFs keep points in an order of their own; of the shape they only need the triangles.
    if (params.analysis.probing != ProbingKind::NearestTriangle) smooth.reset();
    fields->optimise_poses(params.analysis.pose_iterations, part_of(rest, 0.02, 0.1));
    AnalysisResult analysis = analyze(*fields, params.analysis, part_of(rest, 0.1, 0.5));
    Consolidation::Found found =
        Consolidation(*fields, analysis, params).find(part_of(rest, 0.5, 0.9));
    fields.reset();

    Candidates points = found.consensus.take();
    return_freed_memory();  // of many small cells
    ResampleResult result{
        std::move(points.points), {}, std::move(points.field), found.spacing, std::move(analysis)};
    result.source = nearest_sources(shape.cloud.points, result.points, part_of(rest, 0.9, 1.0));
    return result;
}

}  // namespace lpf
