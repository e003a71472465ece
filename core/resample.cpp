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

/// A vote moves points: they start so much further apart than they have to be, or so many more than
/// are wanted, as some are dropped.
constexpr double kSpacingToMove = 1 / 0.98;
constexpr double kPointsToDrop = 1.015;

/// Points of a number that is wanted are spread to this share of the spacing that they start with:
/// all of them, and as long as there are enough.
constexpr double kLeastSpread = 0.9;
constexpr double kMostSpread = 1.03;

/// The number of points is met as nearly; else the search starts anew, at most so often.
constexpr double kCountTolerance = 0.019;
constexpr int kMostTries = 3;
constexpr double kShareOfOthers = 0.1;

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

/// Points that all LPFs have voted on, and how far apart they started.
Found take_vote(const FieldSet& fields, const AnalysisResult& analysis,
                const ResampleParams& params, double noise, const Execution& execution) {
    Found found = take_consensus(fields, analysis, params, part_of(execution, 0.0, 0.7));
    put_to_vote(fields, analysis, noise, found.spacing, found.points, part_of(execution, 0.7, 0.9));
    return found;
}

Found find_with_spacing(const FieldSet& fields, const AnalysisResult& analysis,
                        ResampleParams params, double noise, const Execution& execution) {
    const double spacing = params.target_spacing;
    params.target_spacing *= kSpacingToMove;
    Found found = take_vote(fields, analysis, params, noise, execution);
    spread_out({.least = spacing}, found.points, part_of(execution, 0.9, 1.0));
    return {std::move(found.points), spacing};
}

Found find_with_number(const FieldSet& fields, const AnalysisResult& analysis,
                       ResampleParams params, double noise, const Execution& execution) {
    const std::size_t enough = params.target_points;
    const auto wanted = static_cast<double>(enough);
    double aim = kPointsToDrop * wanted;
    for (int tries = 1;; ++tries) {
        // Most often the first is the last: each takes most of what is left of a progress bar.
        const double rest = std::pow(kShareOfOthers, tries - 1);
        const Execution part = part_of(execution, 1 - rest, 1 - kShareOfOthers * rest);
        params.target_points = static_cast<std::size_t>(std::llround(aim));
        Found found = take_vote(fields, analysis, params, noise, part);
        const Apart apart{kLeastSpread * found.spacing, kMostSpread * found.spacing, enough};
        found.spacing = spread_out(apart, found.points, part_of(part, 0.9, 1.0));
        const auto count = static_cast<double>(found.points.size());
        if (std::abs(count - wanted) <= kCountTolerance * wanted || tries == kMostTries) {
            return found;
        }
        aim *= wanted / std::max(1.0, count);
    }
}

/// What all LPFs agree on: their consensus, and where there was noise, their votes on it.
Found find_points(const FieldSet& fields, const AnalysisResult& analysis,
                  const ResampleParams& params, const Execution& execution) {
    const double noise = noise_taken(params);
    if (noise == 0) return take_consensus(fields, analysis, params, execution);
    const auto find = params.target_points > 0 ? find_with_number : find_with_spacing;
    return find(fields, analysis, params, noise, execution);
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
