#include "core/votes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/field/density_map.h"

namespace lpf {
namespace {

/// The error that no field's representation is trusted below [radius].
constexpr float kErrorFloor = 1e-4F;

constexpr float kFixedPoint = 4294967296.0F;  // 2^32
constexpr float kLeastWeight = 0x1p-20F;
constexpr float kLargestWeight = 0x1p10F;

/// A vote to move by this many sigma counts 0.6 times one to stay: in the first round, and in the
/// second.
constexpr double kFirstWidth = 1.3;
constexpr double kSecondWidth = 0.52;

/// The density of an LPF's points is taken within so many sigma of its piece.
constexpr float kSigmasOfDensity = 2.0F;

void add(std::int64_t& sum, float value) {
    std::atomic_ref(sum).fetch_add(static_cast<std::int64_t>(value), std::memory_order_relaxed);
}

/// How much an LPF is believed, relative to the mean: by the squared error that its piece promises,
/// or by the representation error where it has none.
std::vector<float> reliabilities(const FieldSet& fields, const AnalysisResult& analysis,
                                 bool sharp) {
    std::vector<float> errors(analysis.residuals);
    for (std::size_t j = 0; j < errors.size(); ++j) {
        const auto size = static_cast<float>(fields.frames[j].radius / analysis.radius);
        errors[j] = fields.pieces[j].exists() ? fields.pieces[j].squared_error * size * size
                                              : errors[j] * size;
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

/// One round of votes.
class Round {
public:
    /// @param before what the round before has decided; null in the first
    /// @param width  of the likely moves [input length]; 0 = any move is likely
    Round(const FieldSet& fields, const AnalysisResult& analysis, const VoteParams& params,
          const Moves* before, double width)
        : fields_(fields),
          analysis_(analysis),
          params_(params),
          before_(before),
          width_(static_cast<float>(width / analysis.radius)),
          reliability_(reliabilities(fields, analysis, params.sharp)) {}

    void run(Ballot& ballot, const Execution& execution) const {
        fields_.for_each_ball("vote", execution,
                              [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
                                  if (fields_.dimensions[j] == kTooFewPoints) return;
                                  analysis_.dictionary.decode(analysis_.codes[j], worker.decoded);
                                  if (before_) move_as_decided(j, worker.probe.target);
                                  vote(j, worker, ballot);
                              });
    }

private:
    [[nodiscard]] float size_of(std::size_t j) const {
        return static_cast<float>(fields_.frames[j].radius / analysis_.radius);
    }

    /// Moves the points of a flattened target area to where the round before has put them.
    void move_as_decided(std::size_t j, TargetArea& target) const {
        const Piece& piece = fields_.pieces[j];
        const Eigen::Matrix3f to_frame = fields_.frames[j].axes.transpose() / size_of(j);
        for (std::size_t i = 0; i < target.size; ++i) {
            Eigen::Vector3f p(target.x[i], target.y[i], target.z[i]);
            p += piece.mean(p.x(), p.y()) + to_frame * (*before_)[target.index[i]];
            p -= piece.mean(p.x(), p.y());
            target.x[i] = p.x();
            target.y[i] = p.y();
            target.z[i] = p.z();
        }
    }

    void vote(std::size_t j, FieldSet::Worker& worker, Ballot& ballot) const {
        const Piece& piece = fields_.pieces[j];
        const TargetArea& target = worker.probe.target;
        const float size = size_of(j);
        const Eigen::Matrix3f to_world = size * fields_.frames[j].axes;
        DensityMap density;
        if (piece.exists()) density.count(piece, target, kSigmasOfDensity * piece.noise);

        for (std::size_t i = 0; i < target.size; ++i) {
            const float x = target.x[i];
            const float y = target.y[i];
            const float fade = 1.0F - (x * x + y * y);
            if (fade <= 0.0F) continue;
            Eigen::Vector3f move = interpolate(fields_.pattern(), worker.decoded, x, y);
            // Once is enough for what pulls points from beyond a border.
            if (before_ && piece.dimension == kSurface) move.head<2>().setZero();
            move += piece.shape(x + move.x(), y + move.y()) - piece.mean(x, y);
            move.z() -= target.z[i];
            if (piece.is_curve()) move.y() -= y;
            const float weight =
                reliability_[j] * (params_.sharp ? 1.0F : fade * fade) * density.at(x, y);
            const auto propose = [&](const Eigen::Vector3f& to) {
                ballot.vote(target.index[i], weight * likelihood(piece, size * to.norm()),
                            to_world * to);
            };
            const float half_gap = piece.half_gap(x, y);
            propose(move + half_gap * Eigen::Vector3f::UnitZ());
            if (half_gap > 0) propose(move - half_gap * Eigen::Vector3f::UnitZ());
        }
    }

    /// Of a move of this length [radius of the analysis].
    [[nodiscard]] float likelihood(const Piece& piece, float length) const {
        if (width_ <= 0) return 1.0F;
        const float off = length / (width_ * piece.steepness);
        return std::exp(-0.5F * off * off);
    }

    const FieldSet& fields_;
    const AnalysisResult& analysis_;
    const VoteParams& params_;
    const Moves* before_;
    float width_;
    std::vector<float> reliability_;
};

}  // namespace

void Ballot::vote(std::size_t point, float weight, const Eigen::Vector3f& move) {
    const float scaled = kFixedPoint * std::clamp(weight, kLeastWeight, kLargestWeight);
    std::int64_t* sums = sums_.data() + 4 * point;
    add(sums[0], scaled);
    for (int c = 0; c < 3; ++c) add(sums[c + 1], scaled * move[c]);
}

Eigen::Vector3d Ballot::outcome(std::size_t point) const {
    const std::int64_t* sums = sums_.data() + 4 * point;
    if (sums[0] == 0) return Eigen::Vector3d::Zero();
    return Eigen::Vector3d(static_cast<double>(sums[1]), static_cast<double>(sums[2]),
                           static_cast<double>(sums[3])) /
           static_cast<double>(sums[0]);
}

Moves vote(const FieldSet& fields, const AnalysisResult& analysis, const VoteParams& params,
           const Execution& execution) {
    const auto decide = [&](const Moves* before, double width, const Execution& part) {
        Ballot ballot(fields.grid().size());
        Round(fields, analysis, params, before, width).run(ballot, part);
        Moves moves(fields.grid().size());
        for (std::size_t i = 0; i < moves.size(); ++i) {
            moves[i] = ballot.outcome(i).cast<float>();
            if (before) moves[i] += (*before)[i];
        }
        return moves;
    };
    const Moves first = decide(nullptr, kFirstWidth * params.noise, part_of(execution, 0.0, 0.5));
    if (params.noise <= 0) return first;
    return decide(&first, kSecondWidth * params.noise, part_of(execution, 0.5, 1.0));
}

}  // namespace lpf
