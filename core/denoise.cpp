#include "core/denoise.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/field_set.h"

namespace lpf {
namespace {

/// The error that no field's representation is trusted below [radius].
constexpr float kErrorFloor = 1e-4F;

/// Votes are summed in fixed point, so that the order of the threads changes no digit.
constexpr float kFixedPoint = 4294967296.0F;  // 2^32
constexpr float kLeastWeight = 0x1p-20F;
constexpr float kLargestWeight = 0x1p10F;

/// The candidates of all LPFs for every point, summed: weight, and weighted move [radius].
class Ballot {
public:
    explicit Ballot(std::size_t points) : sums_(4 * points, 0) {}

    /// May be called from any number of threads.
    void vote(std::size_t point, float weight, const Eigen::Vector3f& move) {
        const float scaled = kFixedPoint * std::clamp(weight, kLeastWeight, kLargestWeight);
        std::int64_t* sums = sums_.data() + 4 * point;
        add(sums[0], scaled);
        for (int c = 0; c < 3; ++c) add(sums[c + 1], scaled * move[c]);
    }

    /// The weighted mean of the moves proposed for a point; zero where nobody voted.
    [[nodiscard]] Eigen::Vector3d outcome(std::size_t point) const {
        const std::int64_t* sums = sums_.data() + 4 * point;
        if (sums[0] == 0) return Eigen::Vector3d::Zero();
        return Eigen::Vector3d(static_cast<double>(sums[1]), static_cast<double>(sums[2]),
                               static_cast<double>(sums[3])) /
               static_cast<double>(sums[0]);
    }

private:
    static void add(std::int64_t& sum, float value) {
        std::atomic_ref(sum).fetch_add(static_cast<std::int64_t>(value), std::memory_order_relaxed);
    }

    std::vector<std::int64_t> sums_;
};

/// How much an LPF is believed, by its representation error [input length] relative to the mean.
std::vector<float> reliabilities(const AnalysisResult& analysis, bool sharp) {
    std::vector<float> errors(analysis.residuals);
    for (std::size_t j = 0; j < errors.size(); ++j) {
        errors[j] *= static_cast<float>(analysis.frames[j].radius / analysis.radius);
    }
    const float mean = std::accumulate(errors.begin(), errors.end(), 0.0F) /
                       static_cast<float>(std::max<std::size_t>(1, errors.size()));
    for (float& error : errors) {
        const float ratio = (mean + kErrorFloor) / (error + kErrorFloor);
        error = sharp ? ratio * ratio * ratio : ratio;
    }
    return errors;
}

/// The consolidated field at a place in the plane: T(x, y), so that nothing snaps to the nodes.
Eigen::Vector3f interpolate(const Pattern& pattern, const std::vector<float>& field, float x,
                            float y) {
    const Pattern::Stencil stencil = pattern.stencil(x, y);
    const int stride = pattern.padded_size();
    Eigen::Vector3f value = Eigen::Vector3f::Zero();
    for (int k = 0; k < 4; ++k) {
        const float* node = field.data() + stencil.node[k];
        value += stencil.weight[k] * Eigen::Vector3f(node[0], node[stride], node[2 * stride]);
    }
    return value;
}

/// Every LPF proposes a place for each point of its target area under its disk (Sec. 4.2).
void vote(const FieldSet& fields, const AnalysisResult& analysis, bool sharp, Ballot& ballot,
          const Execution& execution) {
    const std::vector<float> reliability = reliabilities(analysis, sharp);
    const Pattern& pattern = fields.pattern();
    fields.for_each_target(
        "vote", execution, [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
            if (fields.dimensions[j] == kTooFewPoints) return;
            analysis.dictionary.decode(analysis.codes[j], worker.decoded);
            const Frame& frame = fields.frames[j];
            const auto scale = static_cast<float>(frame.radius / analysis.radius);
            const TargetArea& target = worker.probe.target;
            for (std::size_t i = 0; i < target.size; ++i) {
                const float x = target.x[i];
                const float y = target.y[i];
                const float fade = 1.0F - (x * x + y * y);
                if (fade <= 0.0F) continue;
                Eigen::Vector3f move = interpolate(pattern, worker.decoded, x, y);
                move.z() -= target.z[i];
                const float weight = reliability[j] * (sharp ? 1.0F : fade * fade);
                ballot.vote(target.index[i], weight, scale * (frame.axes * move));
            }
        });
}

/// Eq. 12, with q the current position: the full step, or the share gamma / (1 + gamma) of it.
double step_share(double gamma) { return gamma > 0 ? gamma / (1 + gamma) : 1.0; }

/// Moves the points to their consensus. @returns the RMS of the moves
double move_points(const FieldSet& fields, const Ballot& ballot, double step, Points& points) {
    double squares = 0.0;
    const std::vector<std::uint32_t>& order = fields.grid().order();
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Eigen::Vector3d move = step * ballot.outcome(i);
        points.col(order[i]) += move;
        squares += move.squaredNorm();
    }
    return std::sqrt(squares / static_cast<double>(order.size()));
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

        Ballot ballot(shape.size());
        vote(fields, analysis, params.sharp, ballot, part_of(outer, 0.8, 1.0));
        const double step = step_share(params.gamma) * params.analysis.radius;
        rms_moves.push_back(move_points(fields, ballot, step, current.cloud.points));

        const bool still = rms_moves.back() <= params.stop_ratio * rms_moves.front();
        if (i + 1 == params.iterations || (i > 0 && still) || rms_moves.back() == 0) {
            return {std::move(current.cloud.points), std::move(rms_moves), std::move(analysis)};
        }
        analysis_params.initial_dictionary = std::move(analysis.dictionary);
    }
}

}  // namespace lpf
