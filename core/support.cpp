#include "core/support.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lpf {
namespace {

/// Beyond a straight border, the unit vectors to the points near by sum up to this share of their
/// number or more; among points they cancel out.
constexpr float kOneSided = 0.75F;

/// A place so near a point needs no others around it [support distances].
constexpr float kVeryNear = 0.25F;

/// On a slope, the nearest point may be further off than it is in the plane, up to this many times.
/// What a piece says beyond that, where it bends away from its last points, is no part of the
/// shape.
constexpr float kSlope = 1.2F;

constexpr float kReach = 2.0F;  // target areas are no wider

}  // namespace

Support::Support(const Piece& piece, const TargetArea& target, float distance)
    : distance_(distance) {
    side_ = static_cast<int>(std::min(256.0F, std::ceil(2 * kReach / distance))) + 1;
    std::vector<int> cell(target.size);
    first_.assign(static_cast<std::size_t>(side_ * side_) + 2, 0);
    for (std::size_t i = 0; i < target.size; ++i) {
        cell[i] = cell_of(target.y[i]) * side_ + cell_of(target.x[i]);
        ++first_[static_cast<std::size_t>(cell[i]) + 2];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    points_.resize(target.size);
    for (std::size_t i = 0; i < target.size; ++i) {
        const std::size_t at = first_[static_cast<std::size_t>(cell[i]) + 1]++;
        points_[at] = {{target.x[i], target.y[i]},
                       Eigen::Vector3f(target.x[i], target.y[i], target.z[i]) +
                           piece.mean(target.x[i], target.y[i])};
    }
}

int Support::cell_of(float coordinate) const {
    const float cell = std::max(distance_, 2 * kReach / 256.0F);
    return std::clamp(static_cast<int>((coordinate + kReach) / cell), 0, side_ - 1);
}

/// Visits the points in the cells up to `reach` away from that of the place, until one is enough.
/// @returns whether one was
template <typename Visit>
bool Support::for_each_near(const Eigen::Vector2f& place, int reach, const Visit& visit) const {
    const int column = cell_of(place.x());
    const int row = cell_of(place.y());
    for (int j = std::max(0, row - reach); j <= std::min(side_ - 1, row + reach); ++j) {
        const auto begin = static_cast<std::size_t>(j * side_ + std::max(0, column - reach));
        const auto last = static_cast<std::size_t>(j * side_ + std::min(side_ - 1, column + reach));
        for (std::size_t i = first_[begin]; i < first_[last + 1]; ++i) {
            if (visit(points_[i])) return true;
        }
    }
    return false;
}

bool Support::covers(const Eigen::Vector2f& place, const Eigen::Vector3f& on_piece) const {
    const float squared = distance_ * distance_;
    bool near = false;
    bool near_in_space = false;
    bool very_near = false;
    const bool enough = for_each_near(place, 1, [&](const Point& point) {
        const float apart = (point.in_plane - place).squaredNorm();
        near |= apart <= squared;
        very_near |= apart <= kVeryNear * kVeryNear * squared;
        near_in_space |= (point.in_space - on_piece).squaredNorm() <= kSlope * kSlope * squared;
        return very_near && near_in_space;
    });
    return enough || (near && near_in_space && is_surrounded(place));
}

bool Support::is_surrounded(const Eigen::Vector2f& place) const {
    float count = 0;
    Eigen::Vector2f directions = Eigen::Vector2f::Zero();
    for_each_near(place, 2, [&](const Point& point) {
        const Eigen::Vector2f apart = point.in_plane - place;
        const float squared = apart.squaredNorm();
        if (squared > 4 * distance_ * distance_) return false;
        directions += apart / std::sqrt(std::max(squared, 1e-12F));
        count += 1;
        return false;
    });
    return directions.norm() < kOneSided * count;
}

}  // namespace lpf
