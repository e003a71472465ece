#include "core/field/seeding.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/base/gaussian_kernels.h"
#include "core/base/raise.h"
#include "core/field/piece_growth.h"
#include "core/field/seed_sizes.h"
#include "core/shape/poisson_sampling.h"

namespace lpf {
namespace {

/// Errors are estimates: a larger LPF may promise so much more squared error than a smaller one.
constexpr double kTolerance = 1.25;

/// Less squared error is none [squared radius]: of two exact pieces, rounding is not to choose.
constexpr double kExact = 1e-8;

/// Seeds of each size are placed in this many rounds, each where those before left points.
constexpr int kRounds = 2;

/// An LPF takes care of the members of its piece within this share of its radius. Members count
/// that lie a little further off than those that the piece was fitted to: noise alone would
/// otherwise leave points to care for everywhere.
constexpr double kCare = 0.5;
constexpr float kCareOffCurves = 1.3F;

/// A sheet of which less is left than this, when what lies on curves is taken away, is none.
constexpr double kLeastShareOffCurves = 0.3;

/// An LPF of so many points, and so many sigma, is large enough: a larger one could hardly average
/// better.
constexpr std::size_t kEnoughPoints = 4000;
constexpr double kEnoughSigmas = 3.5;

/// More bias makes a misfit [sigma], kept only where it alone takes care of this share of its
/// points.
constexpr double kMostBias = 0.3;
constexpr double kShareOfMisfit = 0.1;

/// From a point that noise has put somewhere to the middle of what is around it: under a kernel 1.2
/// sigma wide, cut off at kShiftReach [sigma].
constexpr float kShiftSharpness = 1 / 1.2F;
constexpr float kShiftReach = 4.0F;
constexpr int kShifts = 3;

/// A place of the shape is cared for if more than this share of the points near it are [sigma].
constexpr float kCaredWithin = 1.5F;
constexpr double kCaredShare = 0.7;

constexpr std::size_t kSeedsPerChunk = 32;
using Indices = std::vector<std::uint32_t>;

/// What has been done for a point: later values count for more.
enum Care : std::uint8_t { kOpen = 0, kTried = 1, kOnSurface = 2, kOnCurve = 3 };

struct Seed {
    std::uint32_t place = 0;  ///< of its point, in the order of the grid
    double noise = 0.0;       ///< there [input length]
    Frame frame;
    Piece piece;
    bool fits = false;
    bool is_needless = false;  ///< the shape there has its LPFs; only noise made the point new
};

/// A size that is tried, and the smaller one that it has to be better than.
struct Trial {
    double radius = 0.0;       ///< [input length]
    double smaller = 0.0;      ///< ratio of the next radius to it; 0: there is no smaller one
    bool last_chance = false;  ///< whatever is left gets an LPF now
};

/// Tries one size after the other: seeds whose radius suits stay; where none does, the points are
/// taken care of by seeds of the next smaller radius.
class Seeding {
public:
    Seeding(const Points& points, const PointGrid& grid, const SeedingParams& params,
            const Execution& execution)
        : points_(points),
          grid_(grid),
          params_(params),
          care_(grid.size(), kOpen),
          outside_(distances_to_region(execution)) {}

    Seeds run(const Execution& execution) {
        const std::vector<double> radii = radii_to_try(params_);
        for (std::size_t k = 0; k < radii.size(); ++k) {
            const bool last = k + 1 == radii.size();
            Trial trial{radii[k], last ? 0.0 : radii[k + 1] / radii[k], false};
            for (int round = 0; round < kRounds; ++round) {
                trial.last_chance = last && round + 1 == kRounds;
                if (trial.last_chance) reopen_tried();
                const double steps = kRounds * static_cast<double>(radii.size());
                const double step = static_cast<double>(k) * kRounds + round;
                place(trial, part_of(execution, step / steps, (step + 1) / steps));
            }
            reopen_tried();
        }
        drop_misfits(execution);
        return result();
    }

private:
    [[nodiscard]] std::vector<double> distances_to_region(const Execution& execution) const {
        std::vector<double> distances(params_.region.empty() ? 0 : grid_.size());
        parallel_for(execution, distances.size(), kPointsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         for (std::size_t i = begin; i < end; ++i) {
                             distances[i] =
                                 distance_to(params_.region, points_.col(grid_.order()[i]));
                         }
                     });
        return distances;
    }

    /// Of the points that nothing takes care of, ascending.
    [[nodiscard]] Indices open_places(double radius, const Execution& execution) const {
        const double reach = params_.target_radius * radius;
        std::vector<Indices> parts(chunk_count(care_.size(), kPointsPerChunk));
        parallel_for(execution, care_.size(), kPointsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                         for (std::size_t i = begin; i < end; ++i) {
                             if (care_[i] != kOpen) continue;
                             if (outside_.empty() || outside_[i] <= reach) {
                                 parts[chunk].push_back(static_cast<std::uint32_t>(i));
                             }
                         }
                     });
        Indices open;
        for (const Indices& part : parts) open.insert(open.end(), part.begin(), part.end());
        return open;
    }

    void reopen_tried() { std::replace(care_.begin(), care_.end(), kTried, kOpen); }

    void place(const Trial& trial, const Execution& execution) {
        const Indices open = open_places(trial.radius, execution);
        if (open.empty()) return;
        const Indices chosen =
            poisson_disk_subset(grid_, open, params_.spacing * trial.radius, params_.random_seed,
                                part_of(execution, 0.0, 0.2));
        std::vector<Seed> seeds(chosen.size());
        parallel_for(part_of(execution, 0.2, 1.0), "seeds", "fields", seeds.size(), kSeedsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         TargetArea target;
                         PieceGrower grower(params_.adapt_radius);
                         for (std::size_t i = begin; i < end; ++i) {
                             seeds[i] = examine(open[chosen[i]], trial, target, grower);
                         }
                     });
        // Curves first: a sheet that is laid across curves is left with none of their points.
        take_care(seeds, true, execution);
        take_care(seeds, false, execution);
        mark_tried(seeds, execution);
        for (const Seed& seed : seeds) {
            if (seed.is_needless) care_[seed.place] = kOnSurface;
        }
        std::ranges::copy_if(seeds, std::back_inserter(seeds_), &Seed::fits);
    }

    /// An LPF at a point: it fits if it promises no larger error than a smaller one there.
    [[nodiscard]] Seed examine(std::uint32_t place, const Trial& trial, TargetArea& target,
                               PieceGrower& grower) const {
        Seed seed;
        seed.place = place;
        seed.frame.centre = points_.col(grid_.order()[place]);
        seed.frame.radius = trial.radius;
        seed.noise = params_.noise * params_.noise_map.factor_at(seed.frame.centre);
        if (!trial.last_chance && !suits_noise(params_, trial.radius, seed.noise)) return seed;
        shift_to_shape(seed, target);
        seed.is_needless = is_cared_for(seed, target);
        if (seed.is_needless) return seed;
        if (params_.noise > 0) {  // else there are no pieces
            gather(seed.frame, target);
            if (trial.smaller > 0 && is_enough(trial, seed.noise, target)) return seed;
            seed.piece = grow(seed.frame, seed.noise, target, grower);
        }
        if (trial.smaller > 0 &&
            is_last_for_noise(params_, trial.smaller * trial.radius, seed.noise)) {
            seed.fits = true;
            return seed;
        }
        seed.fits = trial.smaller > 0 ? suits(seed, trial, target, grower)
                                      : trial.last_chance || explains_its_points(seed.piece);
        return seed;
    }

    /// Whether the smaller size is so large that this one could hardly average better.
    /// @param target of this size
    [[nodiscard]] bool is_enough(const Trial& trial, double noise, const TargetArea& target) const {
        if (trial.smaller * trial.radius < kEnoughSigmas * noise) return false;
        if (target.size <= kEnoughPoints) return false;
        const auto reach = static_cast<float>(trial.smaller * params_.target_radius);
        std::size_t within = 0;
        for (std::size_t i = 0; i < target.size; ++i) {
            const Eigen::Vector3f place(target.x[i], target.y[i], target.z[i]);
            within += static_cast<std::size_t>(place.squaredNorm() <= reach * reach);
        }
        return within > kEnoughPoints;
    }

    [[nodiscard]] bool explains_its_points(const Piece& piece) const {
        if (params_.noise <= 0) return true;
        return piece.exists() && piece.squared_bias <= piece.squared_error - piece.squared_bias;
    }

    /// Whether the piece of a seed promises no larger error than one of the smaller size there.
    [[nodiscard]] bool suits(const Seed& seed, const Trial& trial, TargetArea& target,
                             PieceGrower& grower) const {
        if (!seed.piece.exists()) return false;
        const auto error = static_cast<double>(seed.piece.squared_error);
        if (error <= kExact) return true;
        Frame smaller = seed.frame;
        smaller.radius *= trial.smaller;
        gather(smaller, target);
        const double enough = error / (kTolerance * trial.smaller * trial.smaller);
        const Piece other = grow(smaller, seed.noise, target, grower, static_cast<float>(enough));
        if (!other.exists()) return true;
        if (seed.piece.is_curve() && !other.is_curve())
            return true;  // as noise is near, it is thick
        return static_cast<double>(other.squared_error) >= enough;
    }

    void gather(const Frame& frame, TargetArea& target) const {
        grid_.gather(frame.centre, frame.radius, static_cast<float>(params_.target_radius), target);
    }

    /// The piece of what is gathered.
    [[nodiscard]] Piece grow(const Frame& frame, double noise, const TargetArea& target,
                             PieceGrower& grower, float enough = 0.0F) const {
        return grower.grow(target, static_cast<float>(noise / frame.radius),
                           static_cast<float>(params_.target_radius), enough);
    }

    /// Mean shift with a kernel as wide as the noise.
    void shift_to_shape(Seed& seed, TargetArea& target) const {
        if (params_.noise <= 0) return;
        Frame ball = seed.frame;
        ball.radius = seed.noise;
        grid_.gather(ball.centre, ball.radius, kShiftReach, target);
        Eigen::Vector3f at = Eigen::Vector3f::Zero();
        for (int step = 0; step < kShifts; ++step) {
            const kernels::GaussianMean mean =
                kernels::gaussian_mean(at.data(), kShiftSharpness, target.x.data(), target.y.data(),
                                       target.z.data(), target.size);
            if (mean.weight > 0) at = Eigen::Vector3f(mean.x, mean.y, mean.z) / mean.weight;
        }
        seed.frame.centre += seed.noise * at.cast<double>();
    }

    /// Whether most of the points about a seed belong to LPFs already.
    [[nodiscard]] bool is_cared_for(const Seed& seed, TargetArea& target) const {
        if (params_.noise <= 0) return false;
        Frame ball = seed.frame;
        ball.radius = seed.noise;
        grid_.gather(ball.centre, ball.radius, kCaredWithin, target);
        std::size_t cared = 0;
        for (std::size_t i = 0; i < target.size; ++i) cared += care_[target.index[i]] > kTried;
        return static_cast<double>(cared) > kCaredShare * static_cast<double>(target.size);
    }

    /// Marks the points that LPFs of curves, or all others, take care of.
    void take_care(std::vector<Seed>& seeds, bool of_curves, const Execution& execution) {
        const double reach = std::max(kCare, params_.spacing);
        for_each(seeds, execution, [&](Seed& seed, TargetArea& target) {
            if (!seed.fits || seed.piece.is_curve() != of_curves) return;
            gather_members(seed, reach, target);
            if (seed.piece.exists() && !of_curves && is_made_of_curves(target)) {
                seed.fits = false;
                return;
            }
            mark(target, of_curves ? kOnCurve : kOnSurface);
        });
    }

    /// Near a seed that did not fit, a smaller one is needed.
    void mark_tried(std::vector<Seed>& seeds, const Execution& execution) {
        for_each(seeds, execution, [&](Seed& seed, TargetArea& target) {
            if (seed.fits || seed.is_needless) return;
            gather_members(seed, params_.spacing, target);
            mark(target, kTried);
        });
    }

    /// LPFs that leave much of the shape unexplained do harm where better ones care for their
    /// points.
    void drop_misfits(const Execution& execution) {
        if (params_.noise <= 0) return;  // there are no pieces
        std::ranges::fill(care_, kOpen);
        const double reach = std::max(kCare, params_.spacing);
        const auto is_misfit = [&](const Seed& seed) {
            const double bias =
                std::sqrt(static_cast<double>(seed.piece.squared_bias)) * seed.frame.radius;
            return seed.piece.exists() && bias > kMostBias * seed.noise;
        };
        for_each(seeds_, execution, [&](Seed& seed, TargetArea& target) {
            if (is_misfit(seed)) return;
            gather_members(seed, reach, target);
            mark(target, kOnSurface);
        });
        for_each(seeds_, execution, [&](Seed& seed, TargetArea& target) {
            if (!is_misfit(seed)) return;
            gather_members(seed, reach, target);
            std::size_t open = 0;
            for (std::size_t i = 0; i < target.size; ++i) open += care_[target.index[i]] == kOpen;
            seed.fits =
                static_cast<double>(open) > kShareOfMisfit * static_cast<double>(target.size);
        });
        std::erase_if(seeds_, [](const Seed& seed) { return !seed.fits; });
    }

    template <typename Body>
    static void for_each(std::vector<Seed>& seeds, const Execution& execution, const Body& body) {
        parallel_for(execution, seeds.size(), kSeedsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         TargetArea target;
                         for (std::size_t i = begin; i < end; ++i) body(seeds[i], target);
                     });
    }

    void gather_members(const Seed& seed, double reach, TargetArea& target) const {
        grid_.gather(seed.frame.centre, seed.frame.radius, static_cast<float>(reach), target);
        if (!seed.piece.exists()) return;
        Frame frame = seed.frame;
        frame.origin = seed.piece.origin;
        frame.axes = seed.piece.axes;
        target.to_frame(frame);
        flatten(seed.piece, target);
        keep_members(seed.piece, seed.piece.is_curve() ? kCareOffCurves : 1.0F, target);
    }

    [[nodiscard]] bool is_made_of_curves(const TargetArea& target) {
        std::size_t off_curves = 0;
        for (std::size_t i = 0; i < target.size; ++i) {
            const std::atomic_ref<std::uint8_t> care(care_[target.index[i]]);
            off_curves += care.load(std::memory_order_relaxed) != kOnCurve;
        }
        return static_cast<double>(off_curves) <
               kLeastShareOffCurves * static_cast<double>(target.size);
    }

    /// Raises the care of points. The order of threads makes no difference.
    void mark(const TargetArea& target, Care care) {
        for (std::size_t i = 0; i < target.size; ++i) {
            raise(care_[target.index[i]], care);
        }
    }

    /// In the order of the grid, so that neighbours in space are neighbours in work.
    [[nodiscard]] Seeds result() {
        std::ranges::stable_sort(seeds_, {}, &Seed::place);
        Seeds result;
        for (const Seed& seed : seeds_) {
            result.frames.push_back(seed.frame);
            result.pieces.push_back(seed.piece);
        }
        return result;
    }

    const Points& points_;
    const PointGrid& grid_;
    const SeedingParams& params_;
    std::vector<std::uint8_t> care_;  // Care of each point, in the grid's order
    std::vector<double> outside_;  // how far from the region each is, likewise; empty: none given
    std::vector<Seed> seeds_;
};

}  // namespace

Seeds place_seeds(const Points& points, const PointGrid& grid, const SeedingParams& params,
                  const Execution& execution) {
    return Seeding(points, grid, params, execution).run(execution);
}

}  // namespace lpf
