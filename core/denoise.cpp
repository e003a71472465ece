#include "core/denoise.h"

#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/field_set.h"
#include "core/votes.h"

namespace lpf {
namespace {

/// Eq. 12, with q the current position: the full step, or the share gamma / (1 + gamma) of it.
double step_share(double gamma) { return gamma > 0 ? gamma / (1 + gamma) : 1.0; }

/// Moves the points to their consensus. @returns the RMS of the moves
double move_points(const std::vector<std::uint32_t>& order, const Moves& moves, double step,
                   Points& points, const Execution& execution) {
    std::vector<double> squares(chunk_count(order.size(), kPointsPerChunk), 0.0);
    parallel_for(execution, order.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     for (std::size_t i = begin; i < end; ++i) {
                         const Eigen::Vector3d move = step * moves[i].cast<double>();
                         points.col(order[i]) += move;
                         squares[chunk] += move.squaredNorm();
                     }
                 });
    const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
    return std::sqrt(sum / static_cast<double>(order.size()));
}

void validate(const DenoiseParams& params) {
    validate(params.analysis);
    if (params.analysis.probing == ProbingKind::NearestTriangle) {
        throw Error(ErrorCode::InvalidParameter,
                    "Denoising moves points; it cannot probe triangles.", "probing");
    }
    if (params.iterations < 1 || params.iterations > 50) {
        throw Error(ErrorCode::InvalidParameter, "The outer iterations must be 1 to 50.",
                    "denoiseIterations");
    }
    if (!(params.stop_ratio >= 0 && params.stop_ratio <= 1)) {
        throw Error(ErrorCode::InvalidParameter, "The stop ratio must be 0 to 1.", "stopRatio");
    }
    if (!(params.gamma >= 0 && std::isfinite(params.gamma))) {
        throw Error(ErrorCode::InvalidParameter, "Gamma must be 0 or more.", "gamma");
    }
}

}  // namespace

DenoiseResult denoise(const Shape& shape, const DenoiseParams& params, const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points);
    Shape current;
    current.cloud.points = shape.cloud.points;
    std::vector<double> rms_moves;
    AnalysisParams analysis_params = params.analysis;

    for (int i = 0;; ++i) {
        const Execution outer = part_of(execution, static_cast<double>(i) / params.iterations,
                                        static_cast<double>(i + 1) / params.iterations);
        FieldSet fields(current, analysis_params, part_of(outer, 0.0, 0.05));
        fields.optimise_poses(analysis_params.pose_iterations, part_of(outer, 0.05, 0.25));
        AnalysisResult analysis = analyze(fields, analysis_params, part_of(outer, 0.25, 0.8));

        const Moves moves =
            vote(fields, analysis, {.sharp = params.sharp, .noise = analysis_params.noise},
                 part_of(outer, 0.8, 1.0));
        const double step = step_share(params.gamma) * params.analysis.radius;
        rms_moves.push_back(
            move_points(fields.grid().order(), moves, step, current.cloud.points, outer));

        const bool still = rms_moves.back() <= params.stop_ratio * rms_moves.front();
        if (i + 1 == params.iterations || (i > 0 && still) || rms_moves.back() == 0) {
            return {std::move(current.cloud.points), std::move(rms_moves), std::move(analysis)};
        }
        analysis_params.initial_dictionary = std::move(analysis.dictionary);
        analysis_params.noise *= kNoiseLeft;
    }
}

}  // namespace lpf
