#include "core/resample.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/consolidation.h"
#include "core/field_set.h"
#include "core/final_vote.h"
#include "core/nearest_sources.h"

namespace lpf {
namespace {

/// A vote moves points: they start so much further apart than they have to be, and so many more
/// than are wanted, as some are dropped.
constexpr double kSpacingToMove = 1 / 0.98;
constexpr double kPointsToDrop = 1 / 0.985;

/// The number of points is met as nearly; else the search starts anew, at most so often.
constexpr double kCountTolerance = 0.018;
constexpr int kMostTries = 3;

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

struct Found {
    Candidates points;
    double spacing = 0.0;  ///< tau_p [input length]
};

Found take_consensus(const FieldSet& fields, const AnalysisResult& analysis,
                     const ResampleParams& params, const Execution& execution) {
    Consolidation::Found found = Consolidation(fields, analysis, params).find(execution);
    Candidates points = found.consensus.take();
    return_freed_memory();  // of many small cells
    return {std::move(points), found.spacing};
}

/// The noise that denoising has taken from the shape [input length]; 0 = none to speak of.
double noise_taken(const ResampleParams& params) {
    const double noise = params.denoise ? params.denoise->analysis.noise : 0.0;
    return noise > params.analysis.noise ? noise : 0.0;
}

/// What all LPFs agree on: the consensus, and where there was noise, their votes on it.
Found find_points(const FieldSet& fields, const AnalysisResult& analysis,
                  const ResampleParams& params, const Execution& execution) {
    const double noise = noise_taken(params);
    if (noise == 0) return take_consensus(fields, analysis, params, execution);
    ResampleParams ampler = params;
    ampler.target_spacing *= kSpacingToMove;
    const auto wanted = static_cast<double>(params.target_points);
    double aim = kPointsToDrop * wanted;
    for (int tries = 1;; ++tries) {
        const Execution part = step_of(execution, static_cast<std::size_t>(tries - 1), kMostTries);
        ampler.target_points = static_cast<std::size_t>(std::llround(aim));
        Found found = take_consensus(fields, analysis, ampler, part_of(part, 0.0, 0.6));
        found.spacing /= kSpacingToMove;
        put_to_vote(fields, analysis, noise, found.spacing, found.points, part_of(part, 0.6, 0.9));
        spread_out(found.spacing, found.points, part_of(part, 0.9, 1.0));
        const auto count = static_cast<double>(found.points.size());
        const bool is_met = std::abs(count - wanted) <= kCountTolerance * wanted;
        if (params.target_spacing > 0 || is_met || tries == kMostTries) return found;
        aim *= wanted / std::max(1.0, count);
    }
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
    Found found = find_points(*fields, analysis, params, part_of(rest, 0.5, 0.9));
    fields.reset();
    return_freed_memory();
    ResampleResult result{std::move(found.points.points),
                          {},
                          std::move(found.points.field),
                          found.spacing,
                          std::move(analysis)};
    result.source = nearest_sources(shape.cloud.points, result.points, part_of(rest, 0.9, 1.0));
    return result;
}

}  // namespace lpf
