#include "core/field/sheet_split.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/normal_equations.h"
#include "core/field/piece_fit.h"

namespace lpf {
namespace {

/// Sheets nearer to each other than 1.55 sigma cannot be told apart; more than 8 apart, they do not
/// disturb each other [squared half distance, in variances].
constexpr double kThinnest = 0.6;
constexpr double kThickest = 16.0;

/// Where there is less noise [radius], sheets that it hides lie nearer than any detail.
constexpr float kLeastNoise = 0.03F;

/// The surface scatters more than this many variances where a split is looked for.
constexpr double kLeastScatter = 1.3;

/// Both sheets are looked for within this many sigma.
constexpr float kSigmasOfSearch = 6.0F;

/// The kurtosis of noise is 3, of two sheets 3 - 2 s^2, where s is their share of the variance:
/// nearer to the latter than this, it is two sheets.
constexpr double kShareOfKurtosis = 0.7;

constexpr int kRounds = 3;
constexpr double kFewestMembers = 20;
constexpr double kDampingOfTilt = 1e-3;

/// Two sheets bend alike: what lies off the surface midway between them, place by place, is less
/// than this share of their squared half distance. Near an edge it is more.
constexpr float kMostBend = 0.1F;

/// Squared half distance over (1, x, y) about the piece's mean, and the moments of the offsets.
struct Scatter {
    Eigen::Vector3d squared_gap = Eigen::Vector3d::Zero();
    double second = 0;
    double fourth = 0;
};

/// @returns nothing where there are few members, or they scatter less than `least`
std::optional<Scatter> scatter(const PieceSample& sample, const Piece& piece, double least) {
    Scatter result;
    double n = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        if (!sample.is_member(piece, i)) continue;
        result.second += static_cast<double>(sample.squared_offset[i]);
        n += 1;
    }
    if (n < kFewestMembers || result.second < least * n) return std::nullopt;
    NormalEquations<3> equations;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        if (!sample.is_member(piece, i)) continue;
        const double squared = sample.squared_offset[i];
        equations.add({1, sample.x[i], sample.y[i]}, {squared});
        result.fourth += squared * squared;
    }
    equations.damp(1, kDampingOfTilt);
    equations.damp(2, kDampingOfTilt);
    result.squared_gap = equations.solve();
    result.squared_gap[0] -= static_cast<double>(piece.noise) * piece.noise;
    result.second /= n;
    result.fourth /= n;
    return result;
}

bool is_flatter_than_noise(const Scatter& s, double variance) {
    const double share = std::max(0.0, s.second - variance) / s.second;
    return s.fourth / (s.second * s.second) <= 3 - 2 * kShareOfKurtosis * share * share;
}

std::optional<Piece> two_sheets(PieceSample& sample, float sigmas, Piece piece) {
    const double variance = static_cast<double>(piece.noise) * piece.noise;
    piece.reach = kSigmasOfSearch * piece.noise;
    Scatter found;
    for (int round = 0; round < kRounds; ++round) {
        fit_smooth(sample, sample.size(), piece);
        sample.measure(piece, sample.size());
        const double least = round == 0 ? kLeastScatter * variance : 0.0;
        const std::optional<Scatter> now = scatter(sample, piece, least);
        if (!now) return std::nullopt;
        found = *now;
        const double gap = found.squared_gap[0];
        if (gap < kThinnest * variance || gap > kThickest * variance) return std::nullopt;
        piece.reach = 3 * piece.noise + static_cast<float>(std::sqrt(gap));
    }
    if (!is_flatter_than_noise(found, variance)) return std::nullopt;
    estimate_error(sample, piece);
    if (piece.squared_bias > kMostBend * static_cast<float>(found.squared_gap[0])) {
        return std::nullopt;
    }
    for (int k = 0; k < 3; ++k) piece.sheets[k] = static_cast<float>(found.squared_gap[k]);
    piece.reach = sigmas * piece.noise;
    return piece;
}

}  // namespace

void split_sheets(PieceSample& sample, float sigmas, Piece& piece) {
    if (piece.is_curve() || piece.crease.slope != 0 || piece.noise < kLeastNoise) return;
    const std::optional<Piece> split = two_sheets(sample, sigmas, piece);
    if (!split) return;
    piece = *split;
    sample.measure(piece, sample.size());
    estimate_error(sample, piece);
}

}  // namespace lpf
