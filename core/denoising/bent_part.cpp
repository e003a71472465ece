#include "core/denoising/bent_part.h"

#include <algorithm>

#include "core/base/gaussian_kernels.h"
#include "core/base/raise.h"
#include "core/denoising/near_groups.h"
#include "core/field/local_probing_field.h"
#include "core/shape/extent.h"
#include "core/shape/point_grid.h"

namespace lpf {
namespace {

using kernels::kGaussianReach;

/// What deviates less from a plane or a line is one [sigma]; what is less wide than this share of
/// its length [squared] is no plane. If the mean is off the middle by more than this share of the
/// variance [squared], plane or line ends there.
constexpr double kFlat = 0.2;
constexpr double kLeastWidth = 0.15;
constexpr double kEven = 0.1;
constexpr std::size_t kFewestOfPlane = 4;

/// Fewer points within the reach of noise tell nothing; more than these are not looked at.
constexpr double kFewestNear = 24.0;
constexpr double kMostNear = 50.0;
constexpr std::size_t kPlacesOfEstimate = 256;

/// Side of the cells of grids, and of the groups of points that are looked at together [sigma].
constexpr double kCell = 2.0;
constexpr std::size_t kGroupsPerChunk = 32;

/// Whether the points about a place are anything but a plane or a line that goes on [sigma].
bool bends(const TargetArea& near) {
    if (near.size < kFewestOfPlane) return true;
    const PrincipalDirections principal = principal_directions(near);
    const Eigen::Vector3d variance = principal.variances.cast<double>();
    const bool is_line = variance[1] < kFlat * kFlat;
    const bool is_plane = variance[2] < kFlat * kFlat && variance[1] > kLeastWidth * variance[0];
    const bool ends = principal.mean.cast<double>().squaredNorm() > kEven * variance.sum();
    return ends || (!is_line && !is_plane);
}

/// How many points of a grid lie within the reach of noise of one of them, on average.
double mean_near(const PointGrid& grid, double noise) {
    const std::size_t stride = 1 + (grid.size() - 1) / kPlacesOfEstimate;
    NearPoints near;
    double sum = 0;
    double places = 0;
    for (std::size_t i = 0; i < grid.size(); i += stride) {
        grid.gather(grid.point(i), noise, kGaussianReach, near);
        sum += static_cast<double>(near.size);
        places += 1;
    }
    return sum / places;
}

/// Looks at groups of points, and marks those that are bent and what matters to them.
class Search {
public:
    Search(const Points& shape, double noise, const Execution& execution)
        : noise_(noise), grid_(shape, kCell * noise, execution), near_(mean_near(grid_, noise)) {
        if (near_ < kFewestNear) return;
        const std::size_t stride = stride_to(kMostNear, near_);
        std::vector<std::uint32_t> some;
        for (std::size_t i = 0; i < grid_.size(); i += stride) some.push_back(grid_.order()[i]);
        some_ = PointGrid(selected(shape, some, execution), kCell * noise, execution);
    }

    [[nodiscard]] BentPart run(const Region& region, double margin, const Execution& execution) {
        BentPart part;
        part.near = near_;
        if (near_ < kFewestNear) return part;
        role_.assign(grid_.size(), kIdle);
        const auto groups = near_groups(
            grid_.size(), kCell * noise_, [&](std::size_t i) { return grid_.point(i); }, execution);
        parallel_for(execution, "deconvolve", "groups", groups.size(), kGroupsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         TargetArea near;
                         for (std::size_t g = begin; g < end; ++g) {
                             if (distance_to(region, groups[g].centre) > margin) continue;
                             look_at(groups[g], near);
                         }
                     });
        for (std::size_t i = 0; i < role_.size(); ++i) {
            if (role_[i] == kIdle) continue;
            const auto place = static_cast<std::uint32_t>(part.points.size());
            if (role_[i] == kBent) part.bent.push_back(place);
            part.points.push_back(grid_.order()[i]);
        }
        return part;
    }

private:
    enum Role : std::uint8_t { kIdle, kMatters, kBent };

    void look_at(const NearGroup& group, TargetArea& near) {
        gather_around(some_, group, noise_, kGaussianReach, near);
        if (!bends(near)) return;
        // Points explain the scan within their reach, and so do others within theirs.
        gather_around(grid_, group, noise_, 2 * kGaussianReach, near);
        for (std::size_t k = 0; k < near.size; ++k) raise(role_[near.index[k]], kMatters);
        for (std::size_t i = group.begin; i < group.end; ++i) raise(role_[i], kBent);
    }

    double noise_;
    PointGrid grid_;
    double near_;
    PointGrid some_{Points(3, 0), 1.0};  // of the points
    std::vector<std::uint8_t> role_;     // Role of each point, in the grid's order
};

}  // namespace

BentPart find_bent_part(const Points& shape, double noise, const Region& region, double margin,
                        const Execution& execution) {
    return Search(shape, noise, execution).run(region, margin, execution);
}

Points one_in(std::size_t stride, const Points& points) {
    return points(Eigen::all, Eigen::seq(0, points.cols() - 1, static_cast<Eigen::Index>(stride)));
}

std::size_t stride_to(double most, double count) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(count / most));
}

}  // namespace lpf
