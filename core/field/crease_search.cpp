#include "core/field/crease_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/crease_kernels.h"
#include "core/base/kernels.h"
#include "core/base/normal_equations.h"
#include "core/field/piece_fit.h"

namespace lpf {
namespace {

/// A bias below this share of the error by noise is not worth a search.
constexpr float kLeastBias = 0.5F;

/// The creased piece must err less than this share of the smooth one, and lose few of its members.
constexpr float kMostError = 0.7F;
constexpr double kLeastMembers = 0.9;

/// A crease is one if it is no artefact of noise, neither flat nor a wall, passes the middle, and
/// has members on both sides.
constexpr double kLeastSigmas = 6.0;
constexpr float kLeastSlope = 0.2F;
constexpr float kMostSteepness = 2.0F;
constexpr float kMostOffCentre = 0.35F;
constexpr double kLeastOnEachSide = 0.2;

/// First guess: two planes to the means of blocks, for some directions and offsets.
constexpr int kBlocks = 7;
constexpr std::size_t kPointsAtOnce = 256;
constexpr int kDirections = 12;
constexpr int kOffsets = 2;  // to either side
constexpr double kOffsetStep = 0.25;
constexpr double kLeastFree = 1e-5;  // of what a plane leaves of the distances: less is rounding

/// Refinement, by Gauss and Newton: how far a step may turn or shift the crease.
constexpr int kRounds = 4;
constexpr std::size_t kPointsOfRound = 400;  // enough but for the last
constexpr double kLongestStep = 0.3;
constexpr float kFirstReach = 0.15F;
constexpr double kFlattestSlope = 0.05;
constexpr double kDampingOfBends = 1e-4;
constexpr double kDamping = 1e-10;

struct Line {
    double angle = 0;  ///< of its normal
    double at = 0;
    [[nodiscard]] double x() const { return std::cos(angle); }
    [[nodiscard]] double y() const { return std::sin(angle); }
};

void set_line(const Line& line, Crease& crease) {
    crease.normal_x = static_cast<float>(line.x());
    crease.normal_y = static_cast<float>(line.y());
    crease.at = static_cast<float>(line.at);
}

/// Means of the points in the blocks of a raster.
struct BlockMeans {
    static constexpr std::size_t kSize = kBlocks * kBlocks;
    std::array<float, kSize> weight{}, x{}, y{}, z{};

    explicit BlockMeans(const PieceSample& sample) {
        unsigned block[kPointsAtOnce];
        for (std::size_t begin = 0; begin < sample.size(); begin += kPointsAtOnce) {
            const std::size_t n = std::min(kPointsAtOnce, sample.size() - begin);
            kernels::block_numbers(&sample.x[begin], &sample.y[begin], sample.extent(), kBlocks, n,
                                   block);
            for (std::size_t i = 0; i < n; ++i) add(block[i], sample, begin + i);
        }
        for (std::size_t b = 0; b < kSize; ++b) {
            const float count = std::max(weight[b], 1.0F);
            x[b] /= count;
            y[b] /= count;
            z[b] /= count;
        }
    }

private:
    void add(unsigned b, const PieceSample& sample, std::size_t i) {
        weight[b] += 1;
        x[b] += sample.x[i];
        y[b] += sample.y[i];
        z[b] += sample.z[i];
    }
};

/// The lines that a guess is made among, and some that are never taken, for whole vectors.
struct Guesses {
    static constexpr std::size_t kLines = kDirections * (2 * kOffsets + 1);
    static constexpr std::size_t kSize = (kLines + 15) / 16 * 16;
    std::array<Line, kLines> line;
    std::array<float, kSize> normal_x{}, normal_y{}, at{};

    Guesses() {
        for (int k = 0; k < static_cast<int>(kLines); ++k) {
            const auto i = static_cast<std::size_t>(k);
            line[i] = {k % kDirections * std::numbers::pi / kDirections,
                       (k / kDirections - kOffsets) * kOffsetStep};
            normal_x[i] = static_cast<float>(line[i].x());
            normal_y[i] = static_cast<float>(line[i].y());
            at[i] = static_cast<float>(line[i].at);
        }
    }

    [[nodiscard]] kernels::Lines lines() const {
        return {normal_x.data(), normal_y.data(), at.data(), kSize};
    }
};

/// The best two planes over all points of the target area. What does not depend on the line is
/// eliminated once: each line then costs five sums over the blocks.
Line guess_line(const PieceSample& sample, Piece& piece) {
    static const Guesses kGuesses;
    const BlockMeans blocks(sample);
    NormalEquations<3> plane;
    for (std::size_t b = 0; b < BlockMeans::kSize; ++b) {
        plane.add_weighted({1, blocks.x[b], blocks.y[b]}, blocks.z[b], blocks.weight[b]);
    }
    for (int k = 0; k < 3; ++k) plane.damp(k, kDamping);
    const Eigen::Matrix3d inverse = plane.decomposed().solve(Eigen::Matrix3d::Identity());
    const Eigen::Vector3d flat = inverse * plane.right();

    float of_distance[5][Guesses::kSize];
    kernels::line_sums(kGuesses.lines(), blocks.x.data(), blocks.y.data(), blocks.z.data(),
                       blocks.weight.data(), BlockMeans::kSize, of_distance[0]);
    double most = -1;
    Line best;
    Eigen::Vector3d best_sums = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < Guesses::kLines; ++k) {
        const Eigen::Vector3d sums(of_distance[0][k], of_distance[1][k], of_distance[2][k]);
        const double squares = of_distance[3][k];
        const double free = squares - sums.dot(inverse * sums);
        if (free <= kLeastFree * squares) continue;
        const double slope = (static_cast<double>(of_distance[4][k]) - sums.dot(flat)) / free;
        if (slope * slope * free <= most) continue;
        most = slope * slope * free;
        best = kGuesses.line[k];
        best_sums = sums;
        piece.crease.slope = static_cast<float>(slope);
    }
    const Eigen::Vector3d planes =
        flat - static_cast<double>(piece.crease.slope) * (inverse * best_sums);
    for (int c = 0; c < 3; ++c) piece.coefficients[c] = static_cast<float>(planes[c]);
    return best;
}

void set_steepness(float sigmas, Piece& piece) {
    const float* c = piece.coefficients;
    piece.steepness =
        std::sqrt(1 + c[1] * c[1] + c[2] * c[2] + piece.crease.slope * piece.crease.slope);
    piece.reach = piece.noise * sigmas * piece.steepness;
}

/// Surface, slope and place of the crease at once, from the members.
/// @returns the standard deviation of the slope for noise of unit size; nothing if there is no fold
std::optional<double> refine(PieceSample& sample, float sigmas, Line line, Piece& piece) {
    double deviation = 0;
    for (int round = 0; round < kRounds; ++round) {
        set_line(line, piece.crease);
        set_steepness(sigmas, piece);
        if (round == 0) piece.reach = std::max(piece.reach, piece.steepness * kFirstReach);
        sample.measure(piece, sample.size());
        const bool last = round + 1 == kRounds;
        const std::size_t stride = last ? 1 : 1 + sample.size() / kPointsOfRound;
        double moments[kernels::kCreaseRows * kernels::kCreaseRows];
        kernels::crease_moments(creased_surface(piece), sample.x.data(), sample.y.data(),
                                sample.z.data(), sample.squared_offset.data(),
                                piece.reach * piece.reach, sample.size(), stride, moments);
        NormalEquations<9> equations(moments[0]);
        for (int i = 0; i < 9; ++i) {
            for (int j = 0; j <= i; ++j) equations.set(i, j, moments[i * kernels::kCreaseRows + j]);
            equations.set_right(i, moments[9 * kernels::kCreaseRows + i]);
        }
        for (int k = 0; k < 9; ++k) {
            equations.damp(k, k >= 3 && k < 6 ? kDampingOfBends : kDamping);
        }
        const auto decomposed = equations.decomposed();
        const Eigen::Matrix<double, 9, 1> solution = decomposed.solve(equations.right());
        const double slope = solution[6];
        if (!solution.allFinite() || std::abs(slope) < kFlattestSlope) return std::nullopt;
        const Eigen::Matrix<double, 9, 1> unit = Eigen::Matrix<double, 9, 1>::Unit(6);
        deviation = std::sqrt(decomposed.solve(unit)[6]);
        for (int k = 0; k < 6; ++k) piece.coefficients[k] = static_cast<float>(solution[k]);
        piece.crease.slope = static_cast<float>(slope);
        if (last) break;
        line.at -= std::clamp(solution[7] / slope, -kLongestStep, kLongestStep);
        line.angle += std::clamp(solution[8] / slope, -kLongestStep, kLongestStep);
        if (std::abs(line.at) > 2 * static_cast<double>(kMostOffCentre)) return std::nullopt;
    }
    set_steepness(sigmas, piece);
    sample.measure(piece, sample.size());
    return deviation;
}

bool has_both_sides(const PieceSample& sample, const Piece& piece) {
    double all = 0;
    double beyond = 0;
    for (std::size_t i = 0; i < sample.size(); ++i) {
        if (!sample.is_member(piece, i)) continue;
        all += 1;
        beyond += piece.crease.signed_distance(sample.x[i], sample.y[i]) > 0;
    }
    return std::min(beyond, all - beyond) >= kLeastOnEachSide * all;
}

/// A surface with a crease over the mean plane of all points of the target area.
std::optional<Piece> creased(PieceSample& sample, TargetArea all, const Piece& smooth,
                             float sigmas) {
    const PrincipalDirections principal = principal_directions(all);
    Piece piece;
    piece.dimension = kSurface;
    piece.noise = smooth.noise;
    piece.origin = principal.mean;
    piece.axes = principal.axes;
    sample.look_along(piece, sample.size());
    const Line line = guess_line(sample, piece);
    const std::optional<double> deviation = refine(sample, sigmas, line, piece);
    if (!deviation) return std::nullopt;
    const float slope = std::abs(piece.crease.slope);
    const double by_noise = *deviation * static_cast<double>(piece.noise * piece.steepness);
    if (static_cast<double>(slope) < kLeastSigmas * by_noise || slope < kLeastSlope ||
        piece.steepness > kMostSteepness || std::abs(piece.crease.at) > kMostOffCentre ||
        !has_both_sides(sample, piece)) {
        return std::nullopt;
    }
    return piece;
}

}  // namespace

void fold_at_crease(PieceSample& sample, float sigmas, bool meets_edge, Piece& piece) {
    if (piece.is_curve()) return;
    const float by_noise = piece.squared_error - piece.squared_bias;
    if (piece.squared_bias <= kLeastBias * by_noise && !meets_edge) return;
    const auto before = static_cast<double>(sample.count_members(piece));
    TargetArea all;
    all.x = sample.px;
    all.y = sample.py;
    all.z = sample.pz;
    all.size = sample.size();
    std::optional<Piece> folded = creased(sample, std::move(all), piece, sigmas);
    if (folded) {
        const auto members = static_cast<double>(estimate_error(sample, *folded));
        if (members >= kLeastMembers * before &&
            folded->squared_error <= kMostError * piece.squared_error) {
            piece = *folded;
            return;
        }
    }
    sample.look_along(piece, sample.size());
    sample.measure(piece, sample.size());
}

}  // namespace lpf
