#include "core/denoising/voter.h"

#include <algorithm>
#include <numeric>

#include "core/base/vote_kernels.h"

namespace lpf {
namespace {

/// The error that no field's representation is trusted below [radius].
constexpr float kErrorFloor = 1e-4F;

/// A vote counts so much where no points of the LPF lie.
constexpr float kLeastDensity = 0.001F;

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

}  // namespace

void Arrows::rotate(const Eigen::Matrix3f& by) {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> rows = by;
    kernels::rotate(rows.data(), x.data(), y.data(), z.data(), size());
}

Voter::Voter(const FieldSet& fields, const AnalysisResult& analysis, bool sharp, double width)
    : fields_(fields),
      analysis_(analysis),
      sharp_(sharp),
      width_(static_cast<float>(width / analysis.radius)),
      reliability_(reliabilities(fields, analysis, sharp)) {}

float Voter::size_of(std::size_t j) const {
    return static_cast<float>(fields_.frames[j].radius / analysis_.radius);
}

FieldImage Voter::image(std::size_t j, FieldSet::Worker& worker) const {
    analysis_.dictionary.decode(analysis_.codes[j], worker.decoded);
    FieldImage image(fields_.pattern());
    image.assign(worker.decoded.data());
    return image;
}

Arrows Voter::field_at(const TargetArea& target, const FieldImage& image) {
    Arrows field(target.size);
    float* const out[3] = {field.x.data(), field.y.data(), field.z.data()};
    image.read(target.x.data(), target.y.data(), target.size, out);
    return field;
}

void Voter::stop_sliding(const Piece& piece, Arrows& field) {
    field.x.setZero();
    if (piece.dimension == kSurface) field.y.setZero();
}

void Voter::leave_only_sliding(const Piece& piece, Arrows& field) {
    if (piece.is_curve()) field.y.setZero();
    field.z.setZero();
}

Fit Voter::fit(std::size_t j, const TargetArea& target, const Arrows& field) const {
    const Piece& piece = fields_.pieces[j];
    Fit fit;
    if (!piece.exists()) return fit;
    const MemberOffsets members(piece, target);
    fit.misfit.measure(members, field.y.data(), field.z.data());
    MisfitMap plain;
    plain.measure(members);
    fit.is_plain = plain.mean() <= fit.misfit.mean();
    if (fit.is_plain) fit.misfit = plain;
    return fit;
}

DensityMap Voter::density(std::size_t j, const TargetArea& target) const {
    DensityMap density;
    const Piece& piece = fields_.pieces[j];
    if (piece.exists()) density.count(piece, target, kSigmasOfDensity * piece.noise);
    return density;
}

void Voter::cast(std::size_t j, const TargetArea& target, const Arrows& field, const Trust& trust,
                 Ballot& ballot) const {
    const Piece& piece = fields_.pieces[j];
    Arrows moves = wanted_moves(piece, target, field);
    const Eigen::ArrayXf weights = weights_by_place(j, target, trust);
    if (piece.sheets[0] == 0) {
        cast_moves(j, target, weights, moves, ballot);
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
        cast_moves(j, target, weights, moves, ballot);
        return;
    }
    Arrows other = moves;
    for (std::size_t i = 0; i < target.size; ++i) {
        const float half_gap = piece.half_gap(target.x[i], target.y[i]);
        moves.z[i] += half_gap;
        other.z[i] -= half_gap;
    }
    cast_moves(j, target, weights, moves, ballot);
    cast_moves(j, target, weights, other, ballot);
}

/// From where the points are to the field, on the piece.
Arrows Voter::wanted_moves(const Piece& piece, const TargetArea& target,
                           const Arrows& field) const {
    const float* x = target.x.data();
    const float* y = target.y.data();
    const std::size_t n = target.size;
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
Eigen::ArrayXf Voter::weights_by_place(std::size_t j, const TargetArea& target,
                                       const Trust& trust) const {
    const Piece& piece = fields_.pieces[j];
    const std::size_t n = target.size;
    if (!piece.exists()) return Eigen::ArrayXf::Ones(static_cast<Eigen::Index>(n));
    Eigen::ArrayXf weights(n);
    trust.density.read(target.x.data(), target.y.data(), n, weights.data());
    Eigen::ArrayXf misfit(n);
    trust.misfit.read(target.x.data(), target.y.data(), n, misfit.data());
    const float size = size_of(j);
    const float error = error_off_misfits(piece) + kErrorFloor / (size * size);
    return weights.min(1.0F) * error / (error + misfit);
}

/// @param weights by place
void Voter::cast_moves(std::size_t j, const TargetArea& target, Eigen::ArrayXf weights,
                       Arrows& moves, Ballot& ballot) const {
    const float size = size_of(j);
    const float sigma = width_ * fields_.noise_factors[j] * fields_.pieces[j].steepness / size;
    kernels::weigh({.reliability = reliability_[j],
                    .fades = !sharp_,
                    .least_density = kLeastDensity,
                    .precision = width_ > 0 ? 1.0F / (sigma * sigma) : 0.0F},
                   target.x.data(), target.y.data(), moves.x.data(), moves.y.data(), moves.z.data(),
                   target.size, weights.data());
    moves.rotate(size * fields_.frames[j].axes);
    ballot.cast({.point = {target.index.data(), target.size},
                 .weight = {weights.data(), target.size},
                 .move = {moves.x.data(), moves.y.data(), moves.z.data()}});
}

}  // namespace lpf
