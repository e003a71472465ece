#include "core/field/curve_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/field/piece_fit.h"

namespace lpf {
namespace {

/// Half of a curve lies within half the radius of the target area, of a sheet a quarter.
constexpr double kMostWithinHalfOfSheet = 0.32;

/// A curve leaves the target area: less than this share beyond half its radius is no curve.
constexpr double kLeastBeyondHalfOfCurve = 0.25;

/// In thicker noise curves cannot be told from a sheet.
constexpr float kThickestNoise = 0.2F;

constexpr std::size_t kDirections = 32;
constexpr int kFits = 4;

/// Points that tell directions: beyond this share of the extent, squared.
constexpr float kOuter = 0.3F;

/// A tube along a curve holds this many times the outer points that it holds of an even sheet.
constexpr double kTubeOverSheet = 1.4;
constexpr float kTubeSigmas = 2.0F;

/// Share of a piece's members within half the extent.
double share_within_half(const PieceSample& sample, const Piece& piece) {
    double all = 0;
    double inner = 0;
    const float half = 0.25F * sample.extent() * sample.extent();
    for (std::size_t i = 0; i < sample.size(); ++i) {
        if (!sample.is_member(piece, i)) continue;
        all += 1;
        inner += sample.squared_distance[i] <= half;
    }
    return all > 0 ? inner / all : 1.0;
}

bool goes_on(const PieceSample& sample, const Piece& curve) {
    return 1 - share_within_half(sample, curve) > kLeastBeyondHalfOfCurve;
}

bool looks_like_crossing(const PieceSample& sample, const Piece& piece) {
    if (piece.is_curve()) return !goes_on(sample, piece);
    return piece.noise <= kThickestNoise &&
           share_within_half(sample, piece) > kMostWithinHalfOfSheet;
}

/// The outer points among which a curve is looked for: members of a surface, all around a curve.
std::vector<Eigen::Vector3f> outer_points(const PieceSample& sample, const Piece& piece) {
    std::vector<Eigen::Vector3f> outer;
    const float from = kOuter * sample.extent() * sample.extent();
    for (std::size_t i = 0; i < sample.size(); ++i) {
        if (sample.squared_distance[i] < from) continue;
        if (!piece.is_curve() && !sample.is_member(piece, i)) continue;
        outer.emplace_back(sample.px[i], sample.py[i], sample.pz[i]);
    }
    return outer;
}

struct Direction {
    Eigen::Vector3f along = Eigen::Vector3f::UnitX();
    std::size_t points = 0;  ///< in the tube along it
};

/// The line through the centre near which most of the points lie.
Direction fullest_direction(const std::vector<Eigen::Vector3f>& outer, float width) {
    Direction fullest;
    for (std::size_t k = 0; k < kDirections && !outer.empty(); ++k) {
        const Eigen::Vector3f along = outer[k * outer.size() / kDirections].normalized();
        std::size_t points = 0;
        for (const Eigen::Vector3f& p : outer) {
            const float t = along.dot(p);
            points += static_cast<std::size_t>(p.squaredNorm() - t * t < width * width);
        }
        if (points > fullest.points) fullest = {along, points};
    }
    return fullest;
}

/// Of an even sheet, a tube of this width takes so much of the outer points.
double share_in_tube(float width) {
    const double middle_of_outer = 0.82;  // radius
    const double angle = std::asin(std::min(1.0, static_cast<double>(width) / middle_of_outer));
    return 2 / std::numbers::pi * angle;
}

Piece straight_curve(const Eigen::Vector3f& along, float noise, float sigmas) {
    Piece curve;
    curve.dimension = kCurve;
    curve.noise = noise;
    curve.reach = noise * sigmas;
    curve.axes.col(0) = along;
    curve.axes.col(2) = along.unitOrthogonal();
    curve.axes.col(1) = curve.axes.col(2).cross(along);
    return curve;
}

}  // namespace

void follow_crossing_curve(PieceSample& sample, float sigmas, Piece& piece) {
    if (!looks_like_crossing(sample, piece)) return;
    const std::vector<Eigen::Vector3f> outer = outer_points(sample, piece);
    const float width = kTubeSigmas * piece.noise;
    const Direction direction = fullest_direction(outer, width);
    const double needed = kTubeOverSheet * share_in_tube(width) * static_cast<double>(outer.size());
    if (!piece.is_curve() && static_cast<double>(direction.points) < needed) return;

    Piece curve = straight_curve(direction.along, piece.noise, sigmas);
    sample.look_along(curve, sample.size());
    sample.measure(curve, sample.size());
    for (int round = 0; round < kFits; ++round) {
        fit_smooth(sample, sample.size(), curve);
        sample.measure(curve, sample.size());
    }
    estimate_error(sample, curve);
    if (goes_on(sample, curve)) {
        piece = curve;
        return;
    }
    sample.look_along(piece, sample.size());
    sample.measure(piece, sample.size());
}

}  // namespace lpf
