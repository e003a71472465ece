#include "core/denoise.h"

#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/denoising/deconvolution.h"
#include "core/denoising/outer_iteration.h"
#include "core/denoising/tiled_denoise.h"

namespace lpf {
namespace {

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

/// A large shape, tile by tile.
DenoiseResult denoise_tiles_of(const Points& points, const DenoiseParams& params,
                               const Execution& execution) {
    TiledDenoising done = denoise_tiles(PointsInMemory(points), params, execution);
    Points moved = points;
    parallel_for(execution, done.moves.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         moved.col(static_cast<Eigen::Index>(i)) += done.moves[i].cast<double>();
                     }
                 });
    return {std::move(moved), std::move(done.rms_moves), std::move(done.analysis)};
}

}  // namespace

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
    if (!(params.least_bent >= 0 && params.least_bent <= 1)) {
        throw Error(ErrorCode::InvalidParameter,
                    "The least share of points that is deconvolved must be 0 to 1.", "leastBent");
    }
    if (!(params.gamma >= 0 && std::isfinite(params.gamma))) {
        throw Error(ErrorCode::InvalidParameter, "Gamma must be 0 or more.", "gamma");
    }
}

DenoiseResult denoise(const Shape& shape, const DenoiseParams& params, const Execution& execution) {
    validate(params);
    check_points(shape.cloud.points, execution);
    if (shape.size() > kMostAtOnce) return denoise_tiles_of(shape.cloud.points, params, execution);
    Shape current;
    current.cloud.points = shape.cloud.points;
    std::vector<double> rms_moves;
    DenoiseParams now = params;
    double bent = 0.0;

    for (std::size_t i = 0;; ++i) {
        const Execution part = part_of_iteration(execution, params, i);
        const auto move = [&](const std::vector<std::uint32_t>& order, const Moves& moves) {
            rms_moves.push_back(
                move_points(order, moves, step_length(params), current.cloud.points, part));
        };
        AnalysisResult analysis =
            find_moves(current, now, {}, part_of(part, 0.0, kShareOfMoves), move);
        if (i == 0 && is_deconvolved(params)) {
            bent = static_cast<double>(deconvolve(shape.cloud.points, params.analysis.noise, {},
                                                  current.cloud.points,
                                                  part_of(part, kShareOfMoves, 1.0))
                                           .size()) /
                   static_cast<double>(shape.size());
        }
        if (!goes_on(params, rms_moves, bent)) {
            report_done(execution, "deconvolve", "points");
            return {std::move(current.cloud.points), std::move(rms_moves), std::move(analysis)};
        }
        prepare_next(std::move(analysis.dictionary), now);
    }
}

}  // namespace lpf
