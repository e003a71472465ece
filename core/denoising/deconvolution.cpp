#include "core/denoising/deconvolution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/gaussian_kernels.h"
#include "core/denoising/bent_part.h"
#include "core/denoising/near_groups.h"
#include "core/shape/extent.h"
#include "core/shape/point_grid.h"

namespace lpf {
namespace {

using kernels::GaussianMoments;
using kernels::kGaussianReach;

/// More steps would follow the noise. Points hardly go further than so many sigma in all of them.
constexpr int kSteps = 3;
constexpr float kLongestWay = 0.5F;

/// A point stays where it is unless what it got says so by more than this many times what chance
/// would [squared length].
constexpr float kChance = 1.5F;

/// What is so unlikely, relative to a point on a surface, has hardly come from the shape.
constexpr double kBackground = 1e-5;

/// Side of the cells of grids [sigma].
constexpr double kCell = 2.0;

/// Points that are worked on together lie in a box of this side at most [sigma], in a smaller one
/// if it holds so many: the larger it is, the more is looked at that is near another of them.
constexpr double kLeastSide = 0.5;
constexpr double kPointsOfGroup = 64.0;
constexpr double kLooseness = 1.5;  // for those that move
constexpr std::size_t kGroupsPerChunk = 32;
constexpr std::size_t kPointsPerFollowers = 1024;

/// More points than these within the reach of noise add nothing.
constexpr double kMostOfShape = 500.0;
constexpr double kMostOfScan = 5000.0;

/// A place is thin if so close to it [sigma] there is less than this share of what a surface with
/// the same points around would hold, where that would hold a few.
constexpr float kClose = 0.4F;
constexpr float kThin = 0.7F;
constexpr float kFewestClose = 3.0F;

/// Who is left there follows the mean of those around, by a kernel of this width [sigma], wider
/// where they are few, until it has arrived [sigma].
constexpr double kWidth = 0.5;
constexpr double kWider = 1.6;
constexpr int kWidths = 3;
constexpr float kFewestToFollow = 0.05F;
constexpr int kShifts = 10;
constexpr double kArrived = 0.01;

/// The sum of likelihoods at a place of a surface.
/// @param near points of it within the reach of noise
double sum_on_surface(double near) {
    const double reach = static_cast<double>(kGaussianReach);
    return 2 * near / (reach * reach);
}

/// Side of the groups of points of which so many lie within the reach of noise [sigma].
double side_of_groups(double near) {
    const double reach = static_cast<double>(kGaussianReach);
    const double disk = std::numbers::pi * reach * reach;
    return std::clamp(std::sqrt(kPointsOfGroup * disk / near), kLeastSide, kCell);
}

/// Some points of a cloud, cell by cell.
std::vector<std::uint32_t> by_cells(const std::vector<std::uint32_t>& some, const Points& points,
                                    double cell, const Execution& execution) {
    const PointGrid grid(selected(points, some, execution), cell, execution);
    std::vector<std::uint32_t> sorted;
    sorted.reserve(some.size());
    for (const std::uint32_t i : grid.order()) sorted.push_back(some[i]);
    return sorted;
}

/// A bent part of a cloud and its scan; one method for each step.
class Deconvolution {
public:
    /// @param shape, scan the points that matter, row by row
    Deconvolution(const BentPart& part, Points shape, const Points& scan, double noise,
                  const Execution& execution)
        : side_(side_of_groups(part.near)),
          bent_(by_cells(part.bent, shape, side_ * noise, execution)),
          noise_(noise),
          stride_(stride_to(kMostOfShape, part.near)),
          background_(static_cast<float>(kBackground *
                                         sum_on_surface(part.near / static_cast<double>(stride_)))),
          shape_(std::move(shape)),
          scan_side_(side_of_groups(std::min(part.near, kMostOfScan))),
          scan_(one_in(stride_to(kMostOfScan, part.near), scan), scan_side_ * noise, execution),
          scan_groups_(groups_of_scan(execution)) {}

    Points run(const Execution& execution) && {
        constexpr std::size_t kParts = kSteps + 1;
        for (std::size_t step = 0; step < kSteps; ++step) {
            explain_scan(step_of(execution, step, kParts));
        }
        leave_the_thin(step_of(execution, kSteps, kParts));
        return std::move(shape_);
    }

private:
    /// Expectation, and maximisation as far as it is no chance.
    void explain_scan(const Execution& execution) {
        const std::vector<float> shares = shares_of_scan(part_of(execution, 0.0, 0.5));
        const Execution rest = part_of(execution, 0.5, 1.0);
        for_each(groups_of_bent(rest), scan_, rest, [&](const NearGroup& group, NearPoints& near) {
            std::vector<float> weights(near.size);
            for (std::size_t k = 0; k < near.size; ++k) weights[k] = shares[near.index[k]];
            for (std::size_t i = group.begin; i < group.end; ++i) {
                const GaussianMoments got = moments(within(group, bent(i)), near, weights);
                const Eigen::Vector3f sum(got.x, got.y, got.z);
                const float certain = sum.squaredNorm() - kChance * got.by_chance;
                if (certain <= 0) continue;
                const float step = certain / (sum.squaredNorm() * got.weight);
                shape_.col(bent_[i]) += noise_ * (step * sum).cast<double>();
            }
        });
    }

    /// How often the likelihoods that lead to each point of the scan make one.
    [[nodiscard]] std::vector<float> shares_of_scan(const Execution& execution) const {
        const PointGrid shape = grid_of_shape(execution);
        std::vector<float> shares(scan_.size(), 0.0F);
        for_each(scan_groups_, shape, execution, [&](const NearGroup& group, NearPoints& near) {
            for (std::size_t i = group.begin; i < group.end; ++i) {
                shares[i] = 1 / (sum(within(group, scan_.point(i)), 1.0F, near) + background_);
            }
        });
        return shares;
    }

    void leave_the_thin(const Execution& execution) {
        const PointGrid shape = grid_of_shape(execution);
        const std::vector<std::uint8_t> is_thin = find_thin(shape, part_of(execution, 0.0, 0.5));
        std::vector<std::uint8_t> leads(shape.size(), 1);
        for (std::size_t i = 0; i < bent_.size(); ++i) {
            if (is_thin[i] && is_in_grid(bent_[i])) leads[bent_[i] / stride_] = 0;
        }
        parallel_for(part_of(execution, 0.5, 1.0), "deconvolve", "points", bent_.size(),
                     kPointsPerFollowers, [&](std::size_t begin, std::size_t end, std::size_t) {
                         NearPoints near;
                         for (std::size_t i = begin; i < end; ++i) {
                             if (is_thin[i])
                                 shape_.col(bent_[i]) = follow(bent(i), shape, leads, near);
                         }
                     });
    }

    /// Which of the bent points are left in the thin.
    [[nodiscard]] std::vector<std::uint8_t> find_thin(const PointGrid& shape,
                                                      const Execution& execution) const {
        std::vector<std::uint8_t> is_thin(bent_.size(), 0);
        for_each(groups_of_bent(execution), shape, execution,
                 [&](const NearGroup& group, NearPoints& near) {
                     for (std::size_t i = group.begin; i < group.end; ++i) {
                         const Eigen::Vector3f place = within(group, bent(i));
                         const float on_surface = kClose * kClose * sum(place, 1.0F, near);
                         if (on_surface < kFewestClose) continue;
                         const float itself = is_in_grid(bent_[i]) ? 1.0F : 0.0F;
                         is_thin[i] = sum(place, 1 / kClose, near) - itself < kThin * on_surface;
                     }
                 });
        return is_thin;
    }

    /// Where mean shift leads to. @param leads which points of the shape's grid are followed
    [[nodiscard]] Eigen::Vector3d follow(Eigen::Vector3d place, const PointGrid& shape,
                                         const std::vector<std::uint8_t>& leads,
                                         NearPoints& near) const {
        std::vector<float> weights;
        double moved = 1.0;
        for (int shift = 0; shift < kShifts && moved > kArrived; ++shift) {
            GaussianMoments around{};
            double width = kWidth * noise_;
            for (int k = 0; k < kWidths && around.weight < kFewestToFollow; ++k) {
                if (k > 0) width *= kWider;
                shape.gather(place, width, kGaussianReach, near);
                weights.resize(near.size);
                for (std::size_t i = 0; i < near.size; ++i) {
                    weights[i] = static_cast<float>(leads[shape.order()[near.index[i]]]);
                }
                around = moments(Eigen::Vector3f::Zero(), near, weights);
            }
            if (around.weight < kFewestToFollow) break;
            const Eigen::Vector3f step =
                Eigen::Vector3f(around.x, around.y, around.z) / around.weight;
            place += width * step.cast<double>();
            moved = width * static_cast<double>(step.norm()) / noise_;
        }
        return place;
    }

    [[nodiscard]] Eigen::Vector3d bent(std::size_t i) const { return shape_.col(bent_[i]); }

    /// Whether a point is one of those that stand for all.
    [[nodiscard]] bool is_in_grid(std::uint32_t point) const { return point % stride_ == 0; }

    [[nodiscard]] PointGrid grid_of_shape(const Execution& execution) const {
        return {one_in(stride_, shape_), kCell * noise_, execution};
    }

    [[nodiscard]] std::vector<NearGroup> groups_of_bent(const Execution& execution) const {
        return near_groups(
            bent_.size(), kLooseness * side_ * noise_, [&](std::size_t i) { return bent(i); },
            execution);
    }

    /// Groups of the scan that bent points have to explain, now or when they have moved.
    [[nodiscard]] std::vector<NearGroup> groups_of_scan(const Execution& execution) const {
        const PointGrid bent(selected(shape_, bent_, execution), kCell * noise_, execution);
        auto groups = near_groups(
            scan_.size(), scan_side_ * noise_, [&](std::size_t i) { return scan_.point(i); },
            execution);
        std::vector<std::uint8_t> is_near(groups.size(), 0);
        parallel_for(execution, groups.size(), kGroupsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         NearPoints near;
                         for (std::size_t g = begin; g < end; ++g) {
                             gather_around(bent, groups[g], noise_, kGaussianReach + kLongestWay,
                                           near);
                             is_near[g] = near.size > 0;
                         }
                     });
        std::size_t at = 0;
        std::erase_if(groups, [&](const NearGroup&) { return !is_near[at++]; });
        return groups;
    }

    /// Calls body(group, near) with all of a grid that is in the reach of a group's points.
    template <typename Body>
    void for_each(const std::vector<NearGroup>& groups, const PointGrid& grid,
                  const Execution& execution, const Body& body) const {
        parallel_for(execution, "deconvolve", "groups", groups.size(), kGroupsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         NearPoints near;
                         for (std::size_t g = begin; g < end; ++g) {
                             gather_around(grid, groups[g], noise_, kGaussianReach, near);
                             body(groups[g], near);
                         }
                     });
    }

    /// A place among the points near a group [sigma].
    [[nodiscard]] Eigen::Vector3f within(const NearGroup& group, const Eigen::Vector3d& p) const {
        return ((p - group.centre) / noise_).cast<float>();
    }

    [[nodiscard]] static float sum(const Eigen::Vector3f& place, float sharpness,
                                   const NearPoints& near) {
        return kernels::gaussian_sum(place.data(), sharpness, near.x.data(), near.y.data(),
                                     near.z.data(), near.size);
    }

    [[nodiscard]] static GaussianMoments moments(const Eigen::Vector3f& place,
                                                 const NearPoints& near,
                                                 const std::vector<float>& weights) {
        return kernels::gaussian_moments(place.data(), near.x.data(), near.y.data(), near.z.data(),
                                         weights.data(), near.size);
    }

    double side_;  // of groups of bent points [sigma]
    std::vector<std::uint32_t> bent_;
    double noise_;
    std::size_t stride_;  // one in so many points of the shape stands for all
    float background_;
    Points shape_;
    double scan_side_;  // of groups of the scan [sigma]
    PointGrid scan_;
    std::vector<NearGroup> scan_groups_;
};

}  // namespace

std::vector<std::uint32_t> deconvolve(const Points& scan, double noise, const Region& region,
                                      Points& shape, const Execution& execution) {
    BentPart part = find_bent_part(shape, noise, region, kReachOfDeconvolution / 2 * noise,
                                   part_of(execution, 0.0, 0.2));
    if (part.bent.empty()) return {};
    const Execution rest = part_of(execution, 0.2, 1.0);
    const Points moved = Deconvolution(part, selected(shape, part.points, rest),
                                       selected(scan, part.points, rest), noise, rest)
                             .run(rest);
    for (std::uint32_t& i : part.bent) {
        const std::uint32_t point = part.points[i];
        shape.col(point) = moved.col(i);
        i = point;
    }
    return std::move(part.bent);
}

}  // namespace lpf
