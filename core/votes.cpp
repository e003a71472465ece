#include "core/votes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/ballot.h"
#include "core/base/vote_kernels.h"
#include "core/field/density_map.h"
#include "core/field/field_image.h"
#include "core/field/misfit_map.h"

namespace lpf {
namespace {

/// The error that no field's representation is trusted below [radius].
constexpr float kErrorFloor = 1e-4F;

/// A vote counts so much where no points of the LPF lie.
constexpr float kLeastDensity = 0.001F;

/// A vote to move by this many sigma counts 0.6 times one to stay: in the first round, and in the
/// second.
constexpr double kFirstWidth = 1.3;
constexpr double kSecondWidth = 0.52;

/// The density of an LPF's points is taken within so many sigma of its piece.
constexpr float kSigmasOfDensity = 2.0F;

/// A bias up to about so many sigma is left to the misfit map, which knows where on the disk it is.
constexpr float kSigmasOfMisfit = 0.5F;

/// The squared error that a piece promises wherever its misfit map shows none [squared radius].
float error_off_misfits(const Piece& piece) {
    const float limit = kSigmasOfMisfit * kSigmasOfMisfit * piece.noise * piece.noise;
    const float mapped =
        piece.is_curve() ? 0.0F : piece.squared_bias * limit / (piece.squared_bias + limit);
    return piece.squared_error - mapped;
}

/// How much an LPF is believed, relative to the mean: by the squared error that its piece promises,
/// or by the representation error where it has none.
std::vector<float> reliabilities(const FieldSet& fields, const AnalysisResult& analysis,
                                 bool sharp) {
    std::vector<float> errors(analysis.residuals);
    for (std::size_t j = 0; j < errors.size(); ++j) {
        const auto size = static_cast<float>(fields.frames[j].radius / analysis.radius);
        errors[j] = fields.pieces[j].exists() ? error_off_misfits(fields.pieces[j]) * size * size
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

/// One round of votes.
class Round {
public:
    /// @param before  what the round before has decided; null in the first
    /// @param width   of the likely moves [input length]; 0 = any move is likely
    /// @param misfits one for each LPF; the first round measures them
    Round(const FieldSet& fields, const AnalysisResult& analysis, const VoteParams& params,
          const Moves* before, double width, std::vector<MisfitMap>& misfits)
        : fields_(fields),
          analysis_(analysis),
          params_(params),
          before_(before),
          width_(static_cast<float>(width / analysis.radius)),
          misfits_(misfits),
          reliability_(reliabilities(fields, analysis, params.sharp)) {}

    void run(Ballot& ballot, const Execution& execution) const {
        fields_.for_each_ball("vote", execution,
                              [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
                                  if (fields_.dimensions[j] == kTooFewPoints) return;
                                  analysis_.dictionary.decode(analysis_.codes[j], worker.decoded);
                                  vote(j, worker, ballot);
                              });
    }

private:
    /// A vector for each point of a target area.
    struct Arrows {
        Eigen::ArrayXf x, y, z;  // not zeroed first
        explicit Arrows(std::size_t n) {
            for (auto* values : {&x, &y, &z}) values->resize(static_cast<Eigen::Index>(n));
        }
        [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(x.size()); }
    };

    [[nodiscard]] float size_of(std::size_t j) const {
        return static_cast<float>(fields_.frames[j].radius / analysis_.radius);
    }

    static void rotate(const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>& by, Arrows& arrows) {
        kernels::rotate(by.data(), arrows.x.data(), arrows.y.data(), arrows.z.data(),
                        arrows.size());
    }

    /// Moves the points of a flattened target area to where the round before has put them.
    void move_as_decided(std::size_t j, TargetArea& target) const {
        Arrows moves(target.size);
        for (std::size_t i = 0; i < target.size; ++i) {
            const Eigen::Vector3f& move = (*before_)[target.index[i]];
            moves.x[i] = move.x();
            moves.y[i] = move.y();
            moves.z[i] = move.z();
        }
        rotate(fields_.frames[j].axes.transpose() / size_of(j), moves);
        add_mean_change(fields_.pieces[j], -1.0F, target.x.data(), target.y.data(), moves.x.data(),
                        moves.y.data(), target.size, target.y.data(), target.z.data());
        for (std::size_t i = 0; i < target.size; ++i) {
            target.x[i] += moves.x[i];
            target.y[i] += moves.y[i];
            target.z[i] += moves.z[i];
        }
    }

    void vote(std::size_t j, FieldSet::Worker& worker, Ballot& ballot) const {
        const Piece& piece = fields_.pieces[j];
        TargetArea& target = worker.probe.target;
        if (before_) move_as_decided(j, target);
        Arrows field = field_at(target, worker.decoded);
        if (!before_ && piece.exists()) {
            misfits_[j].measure(piece, target, field.y.data(), field.z.data());
        }
        Arrows moves = wanted_moves(piece, target, std::move(field));
        const Eigen::ArrayXf weights = weights_by_place(j, target);
        if (piece.sheets[0] == 0) {
            cast(j, target, weights, moves, ballot);
            return;
        }
        if (piece.is_tube()) {
            // To the side of it that the points are on.
            for (std::size_t i = 0; i < target.size; ++i) {
                float y = target.y[i];
                float z = target.z[i];
                piece.to_nearer_sheet(target.x[i], 0.0F, y, z);
                moves.y[i] += target.y[i] - y;
                moves.z[i] += target.z[i] - z;
            }
            cast(j, target, weights, moves, ballot);
            return;
        }
        Arrows other = moves;
        for (std::size_t i = 0; i < target.size; ++i) {
            const float half_gap = piece.half_gap(target.x[i], target.y[i]);
            moves.z[i] += half_gap;
            other.z[i] -= half_gap;
        }
        cast(j, target, weights, moves, ballot);
        cast(j, target, weights, other, ballot);
    }

    /// The consolidated field at the points of a target area: T(x, y) between the nodes, too, so
    /// that nothing snaps to them.
    [[nodiscard]] Arrows field_at(const TargetArea& target,
                                  const std::vector<float>& decoded) const {
        Arrows field(target.size);
        FieldImage image(fields_.pattern());
        image.assign(decoded.data());
        float* const out[3] = {field.x.data(), field.y.data(), field.z.data()};
        image.read(target.x.data(), target.y.data(), target.size, out);
        return field;
    }

    /// From where the points are to the field, on the piece.
    [[nodiscard]] Arrows wanted_moves(const Piece& piece, const TargetArea& target,
                                      Arrows field) const {
        const float* x = target.x.data();
        const float* y = target.y.data();
        const std::size_t n = target.size;
        if (before_ && piece.dimension == kSurface) {
            // Once is enough for what pulls points from beyond a border.
            field.x.setZero();
            field.y.setZero();
        }
        Arrows moves = field;
        add_mean_change(piece, 1.0F, x, y, field.x.data(), field.y.data(), n, moves.y.data(),
                        moves.z.data());
        add_shape(piece, x, y, field.x.data(), field.y.data(), n, moves.y.data(), moves.z.data());
        for (std::size_t i = 0; i < n; ++i) moves.z[i] -= target.z[i];
        for (std::size_t i = 0; piece.is_curve() && i < n; ++i) moves.y[i] -= y[i];
        return moves;
    }

    /// What the LPF says at each point counts as much as its own points are dense there, and less
    /// where it does not suit them.
    [[nodiscard]] Eigen::ArrayXf weights_by_place(std::size_t j, const TargetArea& target) const {
        const Piece& piece = fields_.pieces[j];
        const std::size_t n = target.size;
        if (!piece.exists()) return Eigen::ArrayXf::Ones(static_cast<Eigen::Index>(n));
        Eigen::ArrayXf weights(n);
        DensityMap density;
        density.count(piece, target, kSigmasOfDensity * piece.noise);
        density.read(target.x.data(), target.y.data(), n, weights.data());
        Eigen::ArrayXf misfit(n);
        misfits_[j].read(target.x.data(), target.y.data(), n, misfit.data());
        const float size = size_of(j);
        const float error = error_off_misfits(piece) + kErrorFloor / (size * size);
        return weights.min(1.0F) * error / (error + misfit);
    }

    /// @param weights by place
    void cast(std::size_t j, const TargetArea& target, Eigen::ArrayXf weights, Arrows& moves,
              Ballot& ballot) const {
        const float size = size_of(j);
        const float sigma = width_ * fields_.pieces[j].steepness / size;
        kernels::weigh({.reliability = reliability_[j],
                        .fades = !params_.sharp,
                        .least_density = kLeastDensity,
                        .precision = width_ > 0 ? 1.0F / (sigma * sigma) : 0.0F},
                       target.x.data(), target.y.data(), moves.x.data(), moves.y.data(),
                       moves.z.data(), target.size, weights.data());
        rotate(size * fields_.frames[j].axes, moves);
        ballot.cast({.point = {target.index.data(), target.size},
                     .weight = {weights.data(), target.size},
                     .move = {moves.x.data(), moves.y.data(), moves.z.data()}});
    }

    const FieldSet& fields_;
    const AnalysisResult& analysis_;
    const VoteParams& params_;
    const Moves* before_;
    float width_;
    std::vector<MisfitMap>& misfits_;
    std::vector<float> reliability_;
};

}  // namespace

Moves vote(const FieldSet& fields, const AnalysisResult& analysis, const VoteParams& params,
           const Execution& execution) {
    std::vector<MisfitMap> misfits(fields.size());
    const auto decide = [&](const Moves* before, double width, const Execution& part) {
        Ballot ballot(fields.grid().size(), execution);
        Round(fields, analysis, params, before, width, misfits).run(ballot, part);
        Moves moves(fields.grid().size());
        parallel_for(execution, moves.size(), kPointsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         for (std::size_t i = begin; i < end; ++i) {
                             moves[i] = ballot.outcome(i).cast<float>();
                             if (before) moves[i] += (*before)[i];
                         }
                     });
        return moves;
    };
    const Moves first = decide(nullptr, kFirstWidth * params.noise, part_of(execution, 0.0, 0.5));
    if (params.noise <= 0) return first;
    return decide(&first, kSecondWidth * params.noise, part_of(execution, 0.5, 1.0));
}

}  // namespace lpf
