#include "core/resample.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/field_set.h"
#include "core/resampling/consolidation.h"
#include "core/resampling/final_vote.h"
#include "core/resampling/nearest_sources.h"
#include "core/resampling/spacing_search.h"

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

/// The number of points is met as nearly, if it is after so many tries.
constexpr double kCountTolerance = 0.019;
constexpr std::size_t kMostTries = 4;

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

Found points_of(Consolidation::Found found) {
    Candidates points = found.consensus.take();
    return_freed_memory();  // of many small cells
    return {std::move(points), found.spacing};
}

/// The noise that denoising has taken from the shape [input length]; 0 = none to speak of.
double noise_taken(const ResampleParams& params) {
    const double noise = params.denoise ? params.denoise->analysis.noise : 0.0;
    return noise > params.analysis.noise ? noise : 0.0;
}

/// From LPFs to points that are what all of them agree on: their consensus and, where there was
/// noise, their votes on it.
class Agreement {
public:
    Agreement(const FieldSet& fields, const AnalysisResult& analysis, const ResampleParams& params)
        : fields_(fields), analysis_(analysis), params_(params), noise_(noise_taken(params)) {}

    Found find(const Execution& execution) {
        return params_.target_points > 0 ? find_number(execution) : find_spacing(execution);
    }

private:
    [[nodiscard]] bool votes() const { return noise_ > 0; }

    Found find_spacing(const Execution& execution) {
        const double spacing = params_.target_spacing;
        if (votes()) params_.target_spacing *= kSpacingToMove;
        Consolidation consolidation(fields_, analysis_, params_);
        Found found = points_of(consolidation.find(part_of(execution, 0.0, 0.7)));
        vote({.least = spacing}, found, part_of(execution, 0.7, 1.0));
        return {std::move(found.points), spacing};
    }

    /// What is left of one consensus tells how far apart the next is to start.
    Found find_number(const Execution& execution) {
        const std::size_t enough = params_.target_points;
        const auto wanted = static_cast<double>(enough);
        if (votes()) params_.target_points = std::llround(kPointsToDrop * wanted);
        Consolidation consolidation(fields_, analysis_, params_);
        Found found = points_of(consolidation.find(part_of(execution, 0.0, 0.6)));
        SpacingSearch search(found.spacing, wanted);
        for (std::size_t tries = 1;; ++tries) {
            const Execution part = step_of(part_of(execution, 0.6, 1.0), tries - 1, kMostTries);
            vote({kLeastSpread * found.spacing, kMostSpread * found.spacing, enough}, found,
                 part_of(part, 0.0, 0.5));
            const auto count = static_cast<double>(found.points.size());
            if (search.accepts(count, kCountTolerance) || tries == kMostTries) return found;
            found = {};  // gone before there are more
            found = points_of(consolidation.find_again(search.spacing(), part_of(part, 0.5, 1.0)));
        }
    }

    /// Moves the points as all LPFs decide, and keeps them apart.
    void vote(const Apart& apart, Found& found, const Execution& execution) const {
        if (!votes()) return;
        put_to_vote(fields_, analysis_, noise_, found.spacing, found.points,
                    part_of(execution, 0.0, 0.7));
        found.spacing = spread_out(apart, found.points, part_of(execution, 0.7, 1.0));
    }

    const FieldSet& fields_;
    const AnalysisResult& analysis_;
    ResampleParams params_;
    double noise_;
};

}  // namespace

ResampleResult resample(const Shape& shape, const ResampleParams& params,
                        const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points, execution);
    const double denoised = params.denoise ? 0.4 : 0.0;
    std::optional<Shape> smooth = without_noise(shape, params, part_of(execution, 0.0, denoised));
    const Execution rest = part_of(execution, denoised, 1.0);
    std::optional<FieldSet> fields(std::in_place, smooth ? *smooth : shape, params.analysis,
                                   part_of(rest, 0.0, 0.02));
    // The LPFs keep points in an order of their own; of the shape they only need the triangles.
    if (params.analysis.probing != ProbingKind::NearestTriangle) smooth.reset();
    fields->optimise_poses(params.analysis.pose_iterations, part_of(rest, 0.02, 0.1));
    AnalysisResult analysis = analyze(*fields, params.analysis, part_of(rest, 0.1, 0.5));
    Found found = Agreement(*fields, analysis, params).find(part_of(rest, 0.5, 0.9));
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
