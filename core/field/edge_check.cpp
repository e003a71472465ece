#include "core/field/edge_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/kernels.h"

namespace lpf {
namespace {

/// Points lie just off a surface within so many times its reach. At an edge, at least this share of
/// the number of its members do, where these end.
constexpr float kJustOff = 2.0F;
constexpr double kLeastJustOff = 0.1;

/// Members end in and beside blocks that hold less than this share of what blocks hold usually.
constexpr double kShareOfEnd = 0.4;

/// Blocks hold about so many points: with fewer, chance would leave some of them empty.
constexpr double kPointsOfBlock = 20.0;
constexpr int kMostBlocks = 7;  // along an axis
constexpr std::size_t kPointsAtOnce = 256;

/// The members of a surface, and the points just off it, in the blocks of a raster.
class Blocks {
public:
    Blocks(const PieceSample& sample, const Piece& piece, int side) : side_(side) {
        const float reach = piece.reach * piece.reach;
        unsigned block[kPointsAtOnce];
        for (std::size_t begin = 0; begin < sample.size(); begin += kPointsAtOnce) {
            const std::size_t n = std::min(kPointsAtOnce, sample.size() - begin);
            kernels::block_numbers(&sample.x[begin], &sample.y[begin], sample.extent(), side, n,
                                   block);
            for (std::size_t i = 0; i < n; ++i) {
                const float offset = sample.squared_offset[begin + i];
                members_[block[i]] += offset <= reach;
                just_off_[block[i]] += offset > reach && offset <= kJustOff * kJustOff * reach;
            }
        }
    }

    /// Points just off the surface where its members end.
    [[nodiscard]] double just_off_ends() const {
        const double few = kShareOfEnd * usual_members();
        double sum = 0;
        for (int y = 0; y < side_; ++y) {
            for (int x = 0; x < side_; ++x) {
                const bool ends = members_[at(x, y)] < few || is_end(x + 1, y, few) ||
                                  is_end(x - 1, y, few) || is_end(x, y + 1, few) ||
                                  is_end(x, y - 1, few);
                if (ends) sum += just_off_[at(x, y)];
            }
        }
        return sum;
    }

private:
    /// What the block of a member holds on average.
    [[nodiscard]] double usual_members() const {
        double sum = 0;
        double squares = 0;
        for (const double n : members_) {
            sum += n;
            squares += n * n;
        }
        return squares / std::max(sum, 1.0);
    }

    /// A block that lies off the disk for the most part holds few points anyway.
    [[nodiscard]] bool is_end(int x, int y, double few) const {
        constexpr double kMostOfDisk = 0.8;
        const double dx = 2.0 * x + 1 - side_;
        const double dy = 2.0 * y + 1 - side_;
        if (dx * dx + dy * dy >= kMostOfDisk * side_ * side_) return false;
        return members_[at(x, y)] < few;
    }

    [[nodiscard]] std::size_t at(int x, int y) const {
        return static_cast<std::size_t>(y * side_ + x);
    }

    int side_;
    std::array<double, kMostBlocks * kMostBlocks> members_{}, just_off_{};
};

}  // namespace

bool meets_edge(const PieceSample& sample, const Piece& piece) {
    if (piece.is_curve()) return false;
    const auto members = static_cast<double>(sample.count_members(piece));
    const auto near = static_cast<double>(sample.count_within(kJustOff * piece.reach));
    if (near - members <= kLeastJustOff * members) return false;
    const double side = std::sqrt(static_cast<double>(sample.size()) / kPointsOfBlock);
    const Blocks blocks(sample, piece, std::clamp(static_cast<int>(side), 1, kMostBlocks));
    return blocks.just_off_ends() > kLeastJustOff * members;
}

}  // namespace lpf
