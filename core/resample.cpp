#include "core/resample.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/consensus.h"
#include "core/field_set.h"
#include "core/proposals.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr double kCountTolerance = 0.02;
constexpr int kMostSearchRounds = 8;

/// Spacing first, then count: the number of points falls with the square of the spacing on a
/// surface, linearly on a curve; the exponent is taken from the last two tries.
class SpacingSearch {
public:
    SpacingSearch(double first, std::size_t wanted)
        : spacing_(first), wanted_(static_cast<double>(wanted)) {}

    [[nodiscard]] double spacing() const { return spacing_; }

    /// @returns whether `count` points at the current spacing are near enough to those wanted
    bool accepts(std::size_t count) {
        const double found = std::max<double>(1, static_cast<double>(count));
        if (std::abs(found - wanted_) <= kCountTolerance / 2 * wanted_) return true;
        if (last_count_ > 0 && found != last_count_) {
            exponent_ = std::clamp(
                std::log(found / last_count_) / std::log(last_spacing_ / spacing_), 0.7, 3.0);
        }
        last_spacing_ = spacing_;
        last_count_ = found;
        spacing_ *= std::pow(found / wanted_, 1 / exponent_);
        return false;
    }

private:
    double spacing_;
    double wanted_;
    double exponent_ = 2.0;
    double last_spacing_ = 0.0;
    double last_count_ = 0.0;
};

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

/// First guess of tau_p for a number of points, from the area that the disks of all LPFs suggest:
/// seeds are a packing themselves.
double guess_spacing(const FieldSet& fields, const AnalysisParams& params, std::size_t wanted) {
    const double seeds_apart = std::max(params.seed_spacing, 0.05);
    double area = 0.0;
    for (const Frame& frame : fields.frames) {
        area += seeds_apart * seeds_apart * frame.radius * frame.radius;
    }
    return std::sqrt(area / static_cast<double>(wanted));
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

    const bool by_count = params.target_points > 0;
    SpacingSearch search(by_count ? guess_spacing(fields, params.analysis, params.target_points)
                                  : params.target_spacing,
                         params.target_points);
    Candidates candidates;
    Candidates found;
    double spacing = search.spacing();
    const int rounds = by_count ? kMostSearchRounds : 1;
    for (int round = 0; round < rounds; ++round) {
        const double low = 0.5 + 0.4 * round / rounds;
        const double high = 0.5 + 0.4 * (round + 1) / rounds;
        spacing = search.spacing();
        // A finer lattice of places makes a denser packing. After the second try of a search the
        // places stay, so that the number of points changes with the spacing alone.
        if (round < 2) {
            candidates =
                propose(fields, analysis, params, spacing, part_of(rest, low, (low + high) / 2));
        }
        found = find_consensus(candidates, spacing, part_of(rest, (low + high) / 2, high));
        if (by_count && search.accepts(found.size())) break;
    }

    ResampleResult result{
        std::move(found.points), {}, std::move(found.field), spacing, std::move(analysis)};
    result.source = nearest_sources(shape.cloud.points, result.points, part_of(rest, 0.9, 1.0));
    return result;
}

}  // namespace lpf
