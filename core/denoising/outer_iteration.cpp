#include "core/denoising/outer_iteration.h"

#include <algorithm>
#include <utility>

#include "core/field/seed_sizes.h"
#include "core/field_set.h"

namespace lpf {
namespace {

/// Share of the noise that the next outer iteration finds. It is less where it counts for most, at
/// edges, than what LPFs leave anywhere.
constexpr double kNoiseBetween = 0.2;

/// Whether the noise is known, and the points go to where the shape is in one step.
bool goes_all_the_way(const DenoiseParams& params) {
    return params.analysis.noise > 0 && params.gamma == 0;
}

}  // namespace

AnalysisResult find_moves(const Shape& current, const DenoiseParams& params, const Region& region,
                          const Execution& execution, const TakeMoves& take) {
    const AnalysisParams& how = params.analysis;
    FieldSet fields(current, how, part_of(execution, 0.0, 0.05), region);
    fields.optimise_poses(how.pose_iterations, part_of(execution, 0.05, 0.25));
    AnalysisResult analysis = analyze(fields, how, part_of(execution, 0.25, 0.8));
    take(
        fields.grid().order(),
        vote(fields, analysis, {.sharp = params.sharp, .noise = how.noise, .slides = params.slides},
             part_of(execution, 0.8, 1.0)));
    return analysis;
}

double step_length(const DenoiseParams& params) {
    const double share = params.gamma > 0 ? params.gamma / (1 + params.gamma) : 1.0;
    return share * params.analysis.radius;
}

bool is_deconvolved(const DenoiseParams& params) {
    // It knows one width of noise, and would take more than that for bends.
    return goes_all_the_way(params) && params.analysis.noise_map.is_even();
}

bool goes_on(const DenoiseParams& params, const std::vector<double>& rms_moves, double bent) {
    const double last = rms_moves.back();
    const bool still = rms_moves.size() > 1 && last <= params.stop_ratio * rms_moves.front();
    return static_cast<int>(rms_moves.size()) < params.iterations && !still && last != 0 &&
           bent >= params.least_bent;
}

Execution part_of_iteration(const Execution& execution, const DenoiseParams& params,
                            std::size_t i) {
    const auto all = static_cast<std::size_t>(params.iterations);
    if (params.least_bent == 0 || all == 1) return step_of(execution, i, all);
    constexpr double kShareOfFirst = 0.8;
    if (i == 0) return part_of(execution, 0.0, kShareOfFirst);
    return step_of(part_of(execution, kShareOfFirst, 1.0), i - 1, all - 1);
}

void prepare_next(Dictionary dictionary, DenoiseParams& params) {
    params.analysis.initial_dictionary = std::move(dictionary);
    // What was smaller than noise allowed is gone: smaller LPFs would find nothing more.
    params.analysis.least_radius =
        std::max(params.analysis.least_radius,
                 least_radius(params.analysis.noise_map.least() * params.analysis.noise));
    params.analysis.noise *= kNoiseBetween;
    // What noise had carried beyond borders and ends is there now; more would shorten them.
    if (goes_all_the_way(params)) params.slides = false;
}

}  // namespace lpf
