#include "core/resampling/support.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/base/multiversion.h"

namespace lpf {
namespace {

/// Beyond a straight border, the unit vectors to the points near by sum up to this share of their
/// number or more; among points they cancel out.
constexpr float kOneSided = 0.7F;

/// A place so near a point needs no others around it [support distances].
constexpr float kVeryNear = 0.25F;

/// On a slope, the nearest point may be further off than it is in the plane, up to this many times.
/// What a piece says beyond that, where it bends away from its last points, is no part of the
/// shape.
constexpr float kSlope = 1.2F;

constexpr float kReach = 2.0F;  // target areas are no wider

/// So few points are faster looked at all than sought in cells.
constexpr std::size_t kFewPoints = 80;

/// The points in the cells around a place: some runs of them, one for each row of cells.
struct Runs {
    static constexpr int kMost = 5;
    std::uint32_t begin[kMost];
    std::uint32_t end[kMost];
    int size = 0;
};

/// The arrays of the points.
struct PointArrays {
    const float* x;
    const float* y;
    const float* at_x;
    const float* at_y;
    const float* at_z;
};

/// What lies behind the points, so that whole vectors can be read.
constexpr float kNowhere = 1e9F;

using kernels::floats_at;
using kernels::kLanes;

/// Runs are short: of a wider register most would be wasted.
constexpr int kPointsOfRun = 8;

/// Squared distances of the nearest points to a place in the plane and to one in space. Points
/// behind the end of a run may be among them: they are no nearer than a support distance.
template <int kWidth>
LPF_INLINE void find_nearest_in(const Runs& runs, const PointArrays& p, const float* place,
                                const float* on_piece, float* in_plane, float* in_space) {
    constexpr int kUsed = std::min(kWidth, kPointsOfRun);
    using Floats = typename kernels::Registers<kUsed>::Floats;
    Floats least = kNowhere - Floats{};
    Floats least_in_space = least;
    for (int r = 0; r < runs.size; ++r) {
        for (std::uint32_t i = runs.begin[r]; i < runs.end[r]; i += kUsed) {
            const Floats x = floats_at<kUsed>(p.x + i) - place[0];
            const Floats y = floats_at<kUsed>(p.y + i) - place[1];
            const Floats squared = x * x + y * y;
            least = squared < least ? squared : least;
            const Floats at_x = floats_at<kUsed>(p.at_x + i) - on_piece[0];
            const Floats at_y = floats_at<kUsed>(p.at_y + i) - on_piece[1];
            const Floats at_z = floats_at<kUsed>(p.at_z + i) - on_piece[2];
            const Floats squared_in_space = at_x * at_x + at_y * at_y + at_z * at_z;
            least_in_space = squared_in_space < least_in_space ? squared_in_space : least_in_space;
        }
    }
    *in_plane = least[0];
    *in_space = least_in_space[0];
    for (int k = 1; k < kUsed; ++k) {
        *in_plane = least[k] < *in_plane ? least[k] : *in_plane;
        *in_space = least_in_space[k] < *in_space ? least_in_space[k] : *in_space;
    }
}

LPF_WITH_REGISTERS(void, find_nearest,
                   (const Runs& runs, const PointArrays& p, const float* place,
                    const float* on_piece, float* in_plane, float* in_space),
                   (runs, p, place, on_piece, in_plane, in_space))

/// Whether the points within a distance of a place lie on more than one side of it.
LPF_MULTIVERSION
bool surround(const Runs& runs, const PointArrays& p, const float* place, float squared_distance) {
    float count[kLanes] = {};
    float sum_x[kLanes] = {};
    float sum_y[kLanes] = {};
    for (int r = 0; r < runs.size; ++r) {
        for (std::uint32_t i = runs.begin[r]; i < runs.end[r]; i += kLanes) {
            const std::uint32_t left = runs.end[r] - i;
#pragma omp simd
            for (std::uint32_t k = 0; k < kLanes; ++k) {
                const float x = p.x[i + k] - place[0];
                const float y = p.y[i + k] - place[1];
                const float squared = x * x + y * y;
                const float in_run = k < left ? 1.0F : 0.0F;
                const float counts = squared <= squared_distance ? in_run : 0.0F;
                const float share = counts / std::sqrt(squared > 1e-12F ? squared : 1e-12F);
                count[k] += counts;
                sum_x[k] += share * x;
                sum_y[k] += share * y;
            }
        }
    }
    float number = 0.0F;
    float along_x = 0.0F;
    float along_y = 0.0F;
#pragma omp simd reduction(+ : number, along_x, along_y)
    for (int k = 0; k < kLanes; ++k) {
        number += count[k];
        along_x += sum_x[k];
        along_y += sum_y[k];
    }
    const float squared_sum = along_x * along_x + along_y * along_y;
    return squared_sum < kOneSided * kOneSided * number * number;
}

}  // namespace

Support::Support(const Piece& piece, const TargetArea& target, float distance)
    : distance_(distance) {
    const bool few = target.size <= kFewPoints;
    side_ = few ? 1 : static_cast<int>(std::min(256.0F, std::ceil(2 * kReach / distance))) + 1;
    std::vector<int> cell(target.size);
    first_.assign(static_cast<std::size_t>(side_ * side_) + 2, 0);
    for (std::size_t i = 0; i < target.size; ++i) {
        cell[i] = cell_of(target.y[i]) * side_ + cell_of(target.x[i]);
        ++first_[static_cast<std::size_t>(cell[i]) + 2];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    for (auto* values : {&x_, &y_, &at_x_, &at_y_, &at_z_})
        values->assign(target.size + kLanes, kNowhere);
    for (std::size_t i = 0; i < target.size; ++i) {
        const std::size_t to = first_[static_cast<std::size_t>(cell[i]) + 1]++;
        const Eigen::Vector3f in_space = Eigen::Vector3f(target.x[i], target.y[i], target.z[i]) +
                                         piece.mean(target.x[i], target.y[i]);
        x_[to] = target.x[i];
        y_[to] = target.y[i];
        at_x_[to] = in_space.x();
        at_y_[to] = in_space.y();
        at_z_[to] = in_space.z();
    }
}

int Support::cell_of(float coordinate) const {
    const float cell = std::max(distance_, 2 * kReach / 256.0F);
    return std::clamp(static_cast<int>((coordinate + kReach) / cell), 0, side_ - 1);
}

bool Support::covers(const Eigen::Vector2f& place, const Eigen::Vector3f& on_piece) const {
    const int column = cell_of(place.x());
    const int row = cell_of(place.y());
    const auto runs = [&](int reach) {
        Runs result;
        const int left = std::max(0, column - reach);
        const int right = std::min(side_ - 1, column + reach);
        for (int j = std::max(0, row - reach); j <= std::min(side_ - 1, row + reach); ++j) {
            result.begin[result.size] = first_[static_cast<std::size_t>(j * side_ + left)];
            result.end[result.size++] = first_[static_cast<std::size_t>(j * side_ + right) + 1];
        }
        return result;
    };
    const PointArrays points{x_.data(), y_.data(), at_x_.data(), at_y_.data(), at_z_.data()};
    float in_plane = 0.0F;
    float in_space = 0.0F;
    find_nearest(runs(1), points, place.data(), on_piece.data(), &in_plane, &in_space);
    const float squared = distance_ * distance_;
    if (in_plane > squared || in_space > kSlope * kSlope * squared) return false;
    return in_plane <= kVeryNear * kVeryNear * squared ||
           surround(runs(2), points, place.data(), 4 * squared);
}

}  // namespace lpf
