#include "core/field/piece_growth.h"

#include <algorithm>
#include <cmath>

#include "core/field/crease_search.h"
#include "core/field/curve_search.h"
#include "core/field/edge_check.h"
#include "core/field/piece_fit.h"
#include "core/field/sheet_split.h"
#include "core/field/tube_fit.h"

namespace lpf {
namespace {

/// Further off than this many sigma, a point is not of the piece. Noise leaves curves in two
/// directions and goes further off them; where they cross, a narrower piece keeps them apart.
constexpr float kSigmasOffSurface = 2.6F;
constexpr float kSigmasOffCurve = 2.8F;
constexpr float kSigmasOffCrossing = 2.2F;

/// Without noise, this share of the radius is as near as a parabola comes to a shape.
constexpr float kLeastNoise = 0.01F;

/// The first ball must be as wide as the noise is thick, and hold a few points.
constexpr float kSigmasInFirstBall = 3.5F;
constexpr float kPointsInFirstBall = 24.0F;
constexpr float kGrowth = 1.4F;

/// Fewer points show a direction but no bend: while a piece grows, and in the end.
constexpr std::size_t kPointsOfBend = 24;
constexpr std::size_t kFewestOfBend = 12;

/// A first ball that few points rather than noise make as wide may look like a curve by chance. A
/// tube twice as thick as a curve holds less than this times its members, as a strip of a sheet
/// does not.
constexpr double kMostBesideCurve = 1.5;

/// A smooth surface that meets an edge errs by as much as an LPF can: smaller ones keep off the
/// edge.
constexpr float kErrorAtEdge = 1.0F;

/// More points than this add nothing that a piece could tell.
constexpr std::size_t kMostPoints = 3000;

}  // namespace

Piece PieceGrower::grow(const TargetArea& target, float noise, float extent, float enough) {
    if (target.size < kFewestTargetPoints) return {};
    noise = std::max(noise, kLeastNoise);
    const auto points = static_cast<float>(std::min(target.size, kMostPoints));
    const float by_points = extent * std::sqrt(kPointsInFirstBall / points);
    const float by_noise = kSigmasInFirstBall * noise;
    sample_.assign(target, kMostPoints, std::max(by_noise, by_points), kGrowth, extent);

    Piece piece = grow_as(kTooFewPoints, noise);
    if (piece.is_curve() && by_points > by_noise && is_strip(piece)) {
        piece = grow_as(kSurface, noise);
    }
    if (!piece.exists()) return piece;
    follow_crossing_curve(sample_, kSigmasOffCrossing, piece);
    widen_to_tube(sample_, kSigmasOffSurface, piece);
    if (piece.squared_error < enough) return piece;
    const bool at_edge = refuses_edges_ && meets_edge(sample_, piece);
    fold_at_crease(sample_, kSigmasOffSurface, at_edge, piece);
    split_sheets(sample_, kSigmasOffSurface, piece);
    if (refuses_edges_ && meets_edge(sample_, piece)) piece.squared_error = kErrorAtEdge;
    return piece;
}

/// @param dimension of the piece; kTooFewPoints: that of the first ball
Piece PieceGrower::grow_as(Dimension dimension, float noise) {
    Piece piece;
    piece.dimension = dimension;
    piece.noise = noise;
    if (!grow_through_balls(piece)) return {};
    for (int round = 0; round < 2 && sample_.count_members(piece) >= kFewestOfBend; ++round) {
        fit_smooth(sample_, sample_.size(), piece);
        sample_.measure(piece, sample_.size());
    }
    estimate_error(sample_, piece);
    return piece;
}

bool PieceGrower::is_strip(const Piece& curve) const {
    const auto members = static_cast<double>(sample_.count_members(curve));
    const auto in_tube = static_cast<double>(sample_.count_within(2 * curve.reach));
    return in_tube > kMostBesideCurve * members;
}

bool PieceGrower::grow_through_balls(Piece& piece) {
    piece.reach = 1e3F;  // all of the first ball
    std::fill(sample_.squared_offset.begin(), sample_.squared_offset.end(), 0.0F);
    for (std::size_t ball = 0; ball < sample_.balls(); ++ball) {
        if (ball > 0) {
            sample_.look_along(piece, sample_.points_in(ball));
            sample_.measure(piece, sample_.points_in(ball));
        }
        if (!straighten(ball, piece)) return false;
        const std::size_t count = sample_.points_in(ball);
        sample_.measure(piece, count);
        if (members_.size >= kPointsOfBend) {
            fit_smooth(sample_, count, piece);
            sample_.measure(piece, count);
        }
    }
    return true;
}

/// The straight piece along the principal directions of the members in a ball.
bool PieceGrower::straighten(std::size_t ball, Piece& piece) {
    members_.reserve(sample_.size());
    members_.size = 0;
    for (std::size_t i = 0; i < sample_.points_in(ball); ++i) {
        if (!sample_.is_member(piece, i)) continue;
        members_.x[members_.size] = sample_.px[i];
        members_.y[members_.size] = sample_.py[i];
        members_.z[members_.size] = sample_.pz[i];
        ++members_.size;
    }
    if (members_.size < kFewestTargetPoints) return false;
    const PrincipalDirections principal = principal_directions(members_);
    if (!piece.exists()) piece.dimension = local_dimension(principal, members_.size);
    piece.origin = principal.mean;
    piece.axes = principal.axes;
    piece.reach = piece.noise * (piece.is_curve() ? kSigmasOffCurve : kSigmasOffSurface);
    std::fill(std::begin(piece.coefficients), std::end(piece.coefficients), 0.0F);
    sample_.look_along(piece, sample_.points_in(ball));
    return true;
}

}  // namespace lpf
