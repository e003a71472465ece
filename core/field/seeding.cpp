#include "core/field/seeding.h"

#include <algorithm>
#include <cmath>

#include "core/field/local_probing_field.h"
#include "core/shape/hash_grid.h"
#include "core/shape/poisson_sampling.h"

namespace lpf {
namespace {

/// Each try at a place is so much smaller than the one before, four sizes in all.
constexpr double kShrink = 0.7;
constexpr int kSizes = 4;

/// A smaller target area must still show a shape.
constexpr std::size_t kFewestPointsOfSmaller = 20;

/// A right-angled edge spreads by .19 radii off its mean plane, a corner by .24; two sides of a
/// thin part, or a bundle of twigs, by more.
constexpr double kLargestSpread = 0.2;

using Indices = std::vector<std::uint32_t>;

Points select(const Points& points, const Indices& indices) {
    Points selected(3, static_cast<Eigen::Index>(indices.size()));
    for (std::size_t i = 0; i < indices.size(); ++i) {
        selected.col(static_cast<Eigen::Index>(i)) = points.col(indices[i]);
    }
    return selected;
}

/// Whether the radius suits the place: the target area is one sheet or one curve as far as noise
/// lets tell, or has too few points for a smaller radius to help.
bool suits(const Points& points, const PointGrid& grid, std::uint32_t seed, double radius,
           const SeedingParams& params, TargetArea& target) {
    Frame frame;
    frame.centre = points.col(seed);
    frame.radius = radius;
    grid.gather(frame, static_cast<float>(params.target_radius), target);
    const auto left = static_cast<double>(target.size) * kShrink * kShrink;
    if (left < static_cast<double>(kFewestPointsOfSmaller)) return true;
    const double noise = params.noise_spread / radius;
    return static_cast<double>(principal_directions(target).variances[2]) <=
           kLargestSpread * kLargestSpread + noise * noise;
}

/// The points that no seed lies within `reach` of.
Indices uncovered(const Points& points, const Indices& candidates, const Indices& seeds,
                  double reach, const Execution& execution) {
    const Eigen::Vector3d low = points.rowwise().minCoeff();
    HashGrid near(low, (points.rowwise().maxCoeff() - low).maxCoeff(), reach);
    for (const std::uint32_t seed : seeds) near.add(points.col(seed));
    std::vector<std::uint8_t> covered(candidates.size(), 0);
    parallel_for(execution, candidates.size(), 4096,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         near.for_each_near(points.col(candidates[i]),
                                            [&](std::uint32_t, const Eigen::Vector3d&) {
                                                covered[i] = 1;
                                                return false;
                                            });
                     }
                 });
    Indices left;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (!covered[i]) left.push_back(candidates[i]);
    }
    return left;
}

/// Tries one size after the other: seeds whose radius suits stay; where none does, the points are
/// covered by seeds of the next smaller radius.
class Seeding {
public:
    Seeding(const Points& points, const PointGrid& grid, const SeedingParams& params)
        : points_(points),
          grid_(grid),
          params_(params),
          radius_(static_cast<std::size_t>(points.cols()), 0.0) {}

    std::vector<Frame> run(const Execution& execution) {
        Indices open(radius_.size());
        for (std::size_t i = 0; i < open.size(); ++i) open[i] = static_cast<std::uint32_t>(i);
        double radius = params_.radius;
        const int sizes = params_.noise_spread > 0 ? kSizes : 1;
        for (int size = 0; size < sizes && !open.empty(); ++size, radius *= kShrink) {
            const Execution part =
                part_of(execution, static_cast<double>(size) / sizes, (size + 1.0) / sizes);
            open = cover(open, radius, size + 1 == sizes, part);
        }
        return frames();
    }

private:
    /// @returns the points that no seed of a suitable radius covers
    Indices cover(const Indices& open, double radius, bool last, const Execution& execution) {
        const double spacing = params_.spacing * radius;
        const bool all = open.size() == radius_.size();
        Indices seeds = poisson_disk_subset(all ? points_ : select(points_, open), spacing,
                                            params_.random_seed, execution);
        for (std::uint32_t& seed : seeds) seed = open[seed];
        std::vector<std::uint8_t> fits(seeds.size(), 1);
        if (!last) {
            parallel_for(execution, seeds.size(), 128,
                         [&](std::size_t begin, std::size_t end, std::size_t) {
                             TargetArea target;
                             for (std::size_t i = begin; i < end; ++i) {
                                 fits[i] = suits(points_, grid_, seeds[i], radius, params_, target);
                             }
                         });
        }
        Indices kept;
        for (std::size_t i = 0; i < seeds.size(); ++i) {
            if (!fits[i]) continue;
            kept.push_back(seeds[i]);
            radius_[seeds[i]] = radius;
        }
        if (kept.size() == seeds.size()) return {};
        const double reach = std::max(spacing, 1e-9 * radius);
        return uncovered(points_, open, kept, reach, execution);
    }

    /// In the order of the grid, so that neighbours in space are neighbours in work.
    [[nodiscard]] std::vector<Frame> frames() const {
        std::vector<Frame> result;
        for (const std::uint32_t i : grid_.order()) {
            if (radius_[i] <= 0) continue;
            Frame frame;
            frame.centre = points_.col(i);
            frame.radius = radius_[i];
            result.push_back(frame);
        }
        return result;
    }

    const Points& points_;
    const PointGrid& grid_;
    const SeedingParams& params_;
    std::vector<double> radius_;  // of the seed at each point; 0 = no seed
};

}  // namespace

std::vector<Frame> place_seeds(const Points& points, const PointGrid& grid,
                               const SeedingParams& params, const Execution& execution) {
    return Seeding(points, grid, params).run(execution);
}

}  // namespace lpf
