#include "core/resample.h"

#include <utility>

#include "core/base/error.h"
#include "core/consolidation.h"
#include "core/field_set.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

std::vector<std::uint32_t> nearest_sources(const Points& input, const Points& points,
                                           const Execution& execution) {
    const SpatialIndex index(input, execution);
    std::vector<std::uint32_t> source(static_cast<std::size_t>(points.cols()));
    parallel_for(execution, "attributes", "points", source.size(), 4096,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         source[i] =
                             index.nearest(points.col(static_cast<Eigen::Index>(i)), 1)[0].index;
                     }
                 });
    return source;
}

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

}  // namespace

ResampleResult resample(const Shape& shape, const ResampleParams& params,
                        const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points);
    Shape smooth{{shape.cloud.points, {}}, shape.triangles};
    if (params.denoise) {
        smooth.cloud.points = denoise(shape, *params.denoise, part_of(execution, 0.0, 0.4)).points;
    }
    const Execution rest = part_of(execution, params.denoise ? 0.4 : 0.0, 1.0);
    FieldSet fields(smooth, params.analysis, part_of(rest, 0.0, 0.02));
    fields.optimise_poses(params.analysis.pose_iterations, part_of(rest, 0.02, 0.1));
    AnalysisResult analysis = analyze(fields, params.analysis, part_of(rest, 0.1, 0.5));

    Consolidation consolidation(fields, analysis, params);
    const Execution last = part_of(rest, 0.5, 0.9);
    Consolidation::Found found = params.target_points > 0
                                     ? consolidation.with_count(last)
                                     : consolidation.with_spacing(params.target_spacing, last);

    ResampleResult result{std::move(found.points.points),
                          {},
                          std::move(found.points.field),
                          found.spacing,
                          std::move(analysis)};
    result.source = nearest_sources(shape.cloud.points, result.points, part_of(rest, 0.9, 1.0));
    return result;
}

}  // namespace lpf
