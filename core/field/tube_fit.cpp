#include "core/field/tube_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/normal_equations.h"
#include "core/field/piece_fit.h"

namespace lpf {
namespace {

/// Rods thinner than this are curves; thicker ones show surfaces [squared radius, in variances].
constexpr double kThinnest = 0.5;
constexpr double kThickest = 25.0;

/// All sides of it are looked for within this many sigma of the axis.
constexpr float kSigmasOfSearch = 6.0F;

/// Of noise about a curve, the mean fourth power of the distance is twice the squared mean square;
/// about a tube it is 2 - s^2 times that, where s is the tube's share of the mean square. Nearer to
/// the latter than this, it is a tube.
constexpr double kShareOfKurtosis = 0.7;

/// A tube is round: the difference of its moments in two directions is less than this share of
/// their sum.
constexpr double kLeastRound = 0.3;

/// What lies off the tube, place by place, is less than this share of its squared radius.
constexpr float kMostBias = 0.1F;

constexpr int kRounds = 5;
constexpr std::size_t kFewestMembers = 30;
constexpr double kDampingOfTaper = 1e-3;

/// How points scatter about an axis: squared distance over (1, x), and moments.
struct Scatter {
    Eigen::Vector2d squared_radius = Eigen::Vector2d::Zero();
    double second = 0;
    double fourth = 0;
    double unround = 0;
};

std::optional<Scatter> scatter(const PieceSample& sample, const Piece& piece) {
    NormalEquations<2> equations;
    Scatter result;
    double difference = 0;
    double product = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        if (!sample.is_member(piece, i)) continue;
        const Eigen::Vector3f mean = piece.mean(sample.x[i], 0);
        const double dy = sample.y[i] - mean.y();
        const double dz = sample.z[i] - mean.z();
        const double squared = sample.squared_offset[i];
        equations.add({1, sample.x[i]}, {squared});
        result.second += squared;
        result.fourth += squared * squared;
        difference += dy * dy - dz * dz;
        product += 2 * dy * dz;
    }
    const double n = equations.count();
    if (n < kFewestMembers) return std::nullopt;
    equations.damp(1, kDampingOfTaper);
    result.squared_radius = equations.solve();
    result.squared_radius[0] -= 2 * static_cast<double>(piece.noise) * piece.noise;
    result.unround = std::hypot(difference, product) / result.second;
    result.second /= n;
    result.fourth /= n;
    return result;
}

bool is_hollow(const Scatter& s, double variance) {
    const double share = std::max(0.0, s.second - 2 * variance) / s.second;
    return s.fourth / (s.second * s.second) <= 2 - kShareOfKurtosis * share * share;
}

std::optional<Piece> tube(PieceSample& sample, float sigmas, Piece piece) {
    const double variance = static_cast<double>(piece.noise) * piece.noise;
    piece.reach = kSigmasOfSearch * piece.noise;
    Scatter found;
    for (int round = 0; round < kRounds; ++round) {
        fit_smooth(sample, sample.size(), piece);
        sample.measure(piece, sample.size());
        const std::optional<Scatter> now = scatter(sample, piece);
        if (!now) return std::nullopt;
        found = *now;
        const double squared = found.squared_radius[0];
        if (squared < kThinnest * variance || squared > kThickest * variance) return std::nullopt;
        piece.reach = 3 * piece.noise + static_cast<float>(std::sqrt(squared));
    }
    if (found.unround > kLeastRound || !is_hollow(found, variance)) return std::nullopt;
    for (int k = 0; k < 2; ++k) piece.sheets[k] = static_cast<float>(found.squared_radius[k]);
    piece.reach = sigmas * piece.noise;
    sample.measure(piece, sample.size());
    estimate_error(sample, piece);
    if (piece.squared_bias > kMostBias * piece.sheets[0]) return std::nullopt;
    return piece;
}

}  // namespace

void widen_to_tube(PieceSample& sample, float sigmas, Piece& piece) {
    if (!piece.is_curve()) return;
    if (const std::optional<Piece> found = tube(sample, sigmas, piece)) {
        piece = *found;
    } else {
        sample.measure(piece, sample.size());
    }
}

}  // namespace lpf
