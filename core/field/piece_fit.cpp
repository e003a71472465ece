#include "core/field/piece_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/crease_kernels.h"
#include "core/base/kernels.h"
#include "core/base/normal_equations.h"

namespace lpf {
namespace {

/// Keeps a fit determined; bending needs more evidence than a slope.
constexpr double kDamping = 1e-13;
constexpr double kDampingOfBends = 1e-5;

/// Blocks along an axis of a surface, and along a curve.
constexpr int kBlocks = 7;
constexpr int kCurveBlocks = 14;

constexpr std::size_t kPointsAtOnce = 256;

/// A curve holds about as many points everywhere. Blocks that hold so many standard deviations more
/// than the lowest fourth are crowded: another part of the shape passes there. If most are, none
/// is.
constexpr std::ptrdiff_t kBlocksPerUsual = 4;
constexpr double kDeviationsOfCrowd = 3.0;
constexpr std::ptrdiff_t kFewestBlocks = 6;

/// The normal equations of a parabola, from the moments in the order of kernels::parabola_moments.
NormalEquations<6> parabola_equations(const float* moments) {
    // Where x^a y^b is among them, for the products of 1, x, y, xx, xy, yy.
    constexpr int kPowers[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
    NormalEquations<6> equations(moments[0]);
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j <= i; ++j) {
            const int y = kPowers[i][1] + kPowers[j][1];
            const int degree = kPowers[i][0] + kPowers[j][0] + y;
            equations.set(i, j, moments[degree * (degree + 1) / 2 + y]);
        }
        equations.set_right(i, moments[15 + i]);
    }
    return equations;
}

void fit_surface(const PieceSample& sample, std::size_t count, Piece& piece) {
    float moments[21];
    kernels::parabola_moments(sample.x.data(), sample.y.data(), sample.z.data(),
                              sample.squared_offset.data(), piece.reach * piece.reach, count,
                              moments);
    NormalEquations<6> equations = parabola_equations(moments);
    for (int k = 0; k < 6; ++k) equations.damp(k, k < 3 ? kDamping : kDampingOfBends);
    const auto solution = equations.solve();
    if (!solution.allFinite()) return;
    for (int k = 0; k < 6; ++k) piece.coefficients[k] = static_cast<float>(solution(k, 0));
}

std::size_t block_along(float extent, float x, int count) {
    const float share = (x / extent + 1) / 2;
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(share * static_cast<float>(count)), 0, count - 1));
}

/// Which blocks along a curve are crowded, by the first `count` points.
class Crowd {
public:
    Crowd(const PieceSample& sample, std::size_t count, const Piece& piece) : sample_(sample) {
        std::array<double, kCurveBlocks> points{};
        for (std::size_t i = 0; i < count; ++i) points[block_of(i)] += sample.is_member(piece, i);
        std::array<double, kCurveBlocks> usual{};
        const auto end =
            std::ranges::copy_if(points, usual.begin(), [](double n) { return n > 0; }).out;
        const auto used = end - usual.begin();
        if (used < kFewestBlocks) return;
        const auto low = usual.begin() + used / kBlocksPerUsual;
        std::nth_element(usual.begin(), low, end);
        const double most = *low + kDeviationsOfCrowd * std::sqrt(*low);
        const auto is_crowded = [most](double n) { return n > most; };
        if (2 * std::ranges::count_if(points, is_crowded) > used) return;
        std::ranges::transform(points, is_crowded_.begin(), is_crowded);
    }

    [[nodiscard]] bool holds(std::size_t i) const { return is_crowded_[block_of(i)]; }

private:
    [[nodiscard]] std::size_t block_of(std::size_t i) const {
        return block_along(sample_.extent(), sample_.x[i], kCurveBlocks);
    }

    const PieceSample& sample_;
    std::array<bool, kCurveBlocks> is_crowded_{};
};

void fit_curve(const PieceSample& sample, std::size_t count, Piece& piece) {
    const Crowd crowd(sample, count, piece);
    NormalEquations<4, 2> equations;
    for (std::size_t i = 0; i < count; ++i) {
        if (!sample.is_member(piece, i) || crowd.holds(i)) continue;
        const double x = sample.x[i];
        equations.add({1, x, x * x, x * x * x}, {sample.y[i], sample.z[i]});
    }
    for (int k = 0; k < 4; ++k) equations.damp(k, k < 2 ? kDamping : kDampingOfBends);
    const auto solution = equations.solve();
    if (!solution.allFinite()) return;
    for (int k = 0; k < 4; ++k) {
        piece.coefficients[k] = static_cast<float>(solution(k, 0));
        piece.coefficients[4 + k] = static_cast<float>(solution(k, 1));
    }
}

struct Block {
    double points = 0;
    double y = 0;
    double z = 0;
    double squares = 0;
};

using Blocks = std::array<Block, kBlocks * kBlocks>;

/// Of a curve, a block lies along it; of a tube, also around it: (y, z) is the offset from its
/// axis.
std::size_t block_of(const Piece& curve, float extent, float x, float y, float z) {
    if (!curve.is_tube()) return block_along(extent, x, kCurveBlocks);
    constexpr float kHalfTurn = std::numbers::pi_v<float>;
    return block_along(kHalfTurn, std::atan2(z, y), kBlocks) * kBlocks +
           block_along(extent, x, kBlocks);
}

/// What the members of a piece leave of its mean, block by block.
class Remainders {
public:
    Remainders(const PieceSample& sample, const Piece& piece) : sample_(sample), piece_(piece) {
        if (piece.is_curve()) {
            add_curve();
        } else {
            add_surface();
        }
    }

    [[nodiscard]] std::size_t members() const { return members_; }
    [[nodiscard]] const Blocks& blocks() const { return blocks_; }

private:
    void add_curve() {
        const Crowd crowd(sample_, sample_.size(), piece_);
        for (std::size_t i = 0; i < sample_.size(); ++i) {
            if (!sample_.is_member(piece_, i) || crowd.holds(i)) continue;
            const float x = sample_.x[i];
            const Eigen::Vector3f mean = piece_.mean(x, sample_.y[i]);
            float dy = sample_.y[i] - mean.y();
            float dz = sample_.z[i] - mean.z();
            const std::size_t block = block_of(piece_, sample_.extent(), x, dy, dz);
            if (piece_.is_tube()) {
                // Noise moves points outwards on average.
                const float radius = piece_.half_gap(x, 0);
                dz = std::hypot(dy, dz) - std::hypot(radius, piece_.noise);
                dy = 0;
            }
            add(block, dy, dz);
        }
    }

    void add_surface() {
        unsigned block[kPointsAtOnce];
        float offset[kPointsAtOnce];
        for (std::size_t begin = 0; begin < sample_.size(); begin += kPointsAtOnce) {
            const std::size_t n = std::min(kPointsAtOnce, sample_.size() - begin);
            const float* x = &sample_.x[begin];
            const float* y = &sample_.y[begin];
            kernels::block_numbers(x, y, sample_.extent(), kBlocks, n, block);
            std::copy_n(&sample_.z[begin], n, offset);
            if (piece_.crease.slope != 0) {
                kernels::subtract_crease(creased_surface(piece_), x, y, n, offset);
            } else {
                kernels::subtract_parabola(piece_.coefficients, x, y, n, offset);
            }
            for (std::size_t i = 0; i < n; ++i) {
                if (!sample_.is_member(piece_, begin + i)) continue;
                float dy = 0;
                piece_.to_nearer_sheet(x[i], y[i], dy, offset[i]);
                add(block[i], 0, offset[i]);
            }
        }
    }

    void add(std::size_t block, float dy, float dz) {
        Block& of = blocks_[block];
        of.points += 1;
        of.y += dy;
        of.z += dz;
        of.squares += double{dy} * dy + double{dz} * dz;
        ++members_;
    }

    const PieceSample& sample_;
    const Piece& piece_;
    Blocks blocks_{};
    std::size_t members_ = 0;
};

double unknowns_of(const Piece& piece) {
    if (piece.is_curve()) return 8 + (piece.is_tube() ? 2 : 0);
    return 6 + (piece.crease.slope != 0 ? 3 : 0);
}

}  // namespace

void fit_smooth(const PieceSample& sample, std::size_t count, Piece& piece) {
    if (piece.is_curve()) {
        fit_curve(sample, count, piece);
    } else {
        fit_surface(sample, count, piece);
    }
}

std::size_t estimate_error(const PieceSample& sample, Piece& piece) {
    const Remainders remainders(sample, piece);
    const std::size_t members = remainders.members();
    const double unknowns = unknowns_of(piece);
    const auto n = static_cast<double>(members);
    if (n < unknowns + 2) {
        piece.squared_error = 1.0F;
        return members;
    }
    double used = 0;
    double between = 0;
    double within = 0;
    for (const Block& block : remainders.blocks()) {
        if (block.points == 0) continue;
        const double of_means = (block.y * block.y + block.z * block.z) / block.points;
        used += 1;
        between += of_means;
        within += block.squares - of_means;
    }
    const double directions = piece.is_curve() && !piece.is_tube() ? 2 : 1;
    const double variance = n > used + 8 ? within / (n - used) / directions
                                         : static_cast<double>(piece.noise) * piece.noise;
    const double by_noise = std::max(0.0, used * directions - unknowns) * variance;
    const double across = 1 / (static_cast<double>(piece.steepness) * piece.steepness);
    const double bias = across * std::max(0.0, between - by_noise) / n;
    // The axis of a tube is fitted to points that scatter about it by its radius, too.
    const double scatter = variance + (piece.is_tube() ? double{piece.sheets[0]} / 2 : 0);
    const double fit = across * unknowns * scatter / n / static_cast<double>(sample.stride());
    piece.squared_bias = static_cast<float>(bias);
    piece.squared_error = static_cast<float>(bias + fit);
    return members;
}

}  // namespace lpf
