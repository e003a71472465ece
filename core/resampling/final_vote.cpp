#include "core/resampling/final_vote.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>

#include "core/denoising/ballot.h"
#include "core/denoising/voter.h"
#include "core/resampling/blocks.h"
#include "core/shape/extent.h"
#include "core/shape/point_grid.h"

namespace lpf {
namespace {

/// A vote to move by this many sigma of the noise that the shape had counts 0.62 times one to stay:
/// wider than where the points themselves were noisy, since LPFs that disagree are to be averaged.
constexpr double kWidth = 1.6;

/// A point that is moved by more than so many sigma, and this share of the spacing, is a stray.
constexpr double kSigmasOfStray = 1.0;
constexpr double kSpacingOfStray = 0.25;

/// Points that are voted on together: about 100 bytes each.
constexpr std::size_t kPointsOfPart = std::size_t{1} << 20U;

/// Points follow each other in space: a cell of the grid holds about as many as suits balls.
constexpr double kPointsOfCell = 32.0;

constexpr std::size_t kFieldsPerChunk = 32;

/// So that no rounding of a search loses a pair; exact distances decide.
constexpr float kRoundingUp = 1.0001F;

using Numbers = std::vector<std::uint32_t>;

/// Lets some LPFs vote on the points of a grid.
void vote_on(const PointGrid& grid, const FieldSet& fields, const Voter& voter,
             const Numbers& voters, Ballot& ballot, const Execution& execution) {
    parallel_for(execution, "vote", "fields", voters.size(), kFieldsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     FieldSet::Worker worker = fields.make_worker();
                     TargetArea& target = worker.probe.target;
                     for (const std::uint32_t j : std::span(voters).subspan(begin, end - begin)) {
                         if (fields.dimensions[j] == kTooFewPoints) continue;
                         fields.gather_ball(j, target);
                         const DensityMap density = voter.density(j, target);
                         const FieldImage image = voter.image(j, worker);
                         const Fit fit = voter.fit(j, target, Voter::field_at(target, image));
                         fields.gather_ball(j, grid, target);
                         if (target.size == 0) continue;
                         Arrows field = Voter::field_at(target, image);
                         // The points lie on the shape already: they are not to slide along it.
                         if (fit.is_plain) Voter::leave_only_sliding(fields.pieces[j], field);
                         Voter::stop_sliding(fields.pieces[j], field);
                         voter.cast(j, target, field, {fit.misfit, density}, ballot);
                     }
                 });
}

/// Leaves the points that are `kept`, in their order.
void keep(const std::vector<bool>& kept, Candidates& points) {
    Eigen::Index to = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!kept[i]) continue;
        points.points.col(to) = points.points.col(static_cast<Eigen::Index>(i)).eval();
        points.field[static_cast<std::size_t>(to++)] = points.field[i];
    }
    points.points.conservativeResize(Eigen::NoChange, to);
    points.field.resize(static_cast<std::size_t>(to));
}

/// The points of a part, and those before it that are so near that they matter; ascending.
Numbers part_and_before(const Points& points, std::size_t begin, std::size_t end, double margin) {
    const auto part =
        points.middleCols(static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end - begin));
    const Eigen::AlignedBox3d near =
        widened({part.rowwise().minCoeff(), part.rowwise().maxCoeff()}, margin);
    Numbers numbers;
    for (std::size_t i = 0; i < end; ++i) {
        if (i >= begin || near.contains(points.col(static_cast<Eigen::Index>(i)))) {
            numbers.push_back(static_cast<std::uint32_t>(i));
        }
    }
    return numbers;
}

/// Two points that are near each other.
struct Pair {
    double distance;  ///< [input length]
    std::uint32_t later;
    std::uint32_t earlier;
};
using Pairs = std::vector<Pair>;

/// Appends the pairs of some points that are nearer than a distance and of which the later is not
/// before `first`.
void add_near_pairs(const Points& points, const Numbers& numbers, std::size_t first,
                    double distance, Pairs& all, const Execution& execution) {
    const Points some = selected(points, numbers, execution);
    const PointGrid grid(some, distance, execution);
    std::vector<Pairs> of_chunks(chunk_count(numbers.size(), kPointsPerChunk));
    parallel_for(execution, "spread", "points", numbers.size(), kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     NearPoints near;
                     for (std::size_t i = begin; i < end; ++i) {
                         if (numbers[i] < first) continue;
                         const Eigen::Vector3d at = some.col(static_cast<Eigen::Index>(i));
                         grid.gather(at, distance, kRoundingUp, near);
                         for (std::size_t k = 0; k < near.size; ++k) {
                             const std::uint32_t other = grid.order()[near.index[k]];
                             if (other >= i) continue;
                             const double apart = (some.col(other) - at).norm();
                             of_chunks[chunk].push_back({apart, numbers[i], numbers[other]});
                         }
                     }
                 });
    for (const Pairs& pairs : of_chunks) all.insert(all.end(), pairs.begin(), pairs.end());
}

/// All pairs of points nearer than a distance, the nearest first.
Pairs near_pairs(const Points& points, double distance, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    const std::size_t parts = chunk_count(n, kPointsOfPart);
    Pairs pairs;
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t begin = part * kPointsOfPart;
        const std::size_t end = std::min(begin + kPointsOfPart, n);
        add_near_pairs(points, part_and_before(points, begin, end, distance), begin, distance,
                       pairs, step_of(execution, part, parts));
    }
    std::ranges::sort(pairs, {},
                      [](const Pair& p) { return std::tuple(p.distance, p.later, p.earlier); });
    return pairs;
}

}  // namespace

void put_to_vote(const FieldSet& fields, const AnalysisResult& analysis, double noise,
                 double spacing, Candidates& points, const Execution& execution) {
    const Voter voter(fields, analysis, false, kWidth * noise);
    const double far = std::max(kSigmasOfStray * noise, kSpacingOfStray * spacing);
    Numbers all(fields.size());
    std::iota(all.begin(), all.end(), 0U);
    std::vector<bool> kept(points.size(), true);
    const std::size_t parts = chunk_count(points.size(), kPointsOfPart);
    for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t first = part * kPointsOfPart;
        const std::size_t count = std::min(kPointsOfPart, points.size() - first);
        const Points some = points.points.middleCols(static_cast<Eigen::Index>(first),
                                                     static_cast<Eigen::Index>(count));
        const double cell = cell_of_some_points(some, kPointsOfCell, execution);
        const PointGrid grid(some, cell > 0 ? cell : spacing, execution);
        const Eigen::AlignedBox3d space = bounding_box(some, execution);
        Ballot ballot(count, execution);
        vote_on(grid, fields, voter, fields_near(fields.frames, all, space), ballot,
                step_of(execution, part, parts));
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t point = first + grid.order()[i];
            const Eigen::Vector3d move = analysis.radius * ballot.outcome(i);
            points.points.col(static_cast<Eigen::Index>(point)) += move;
            kept[point] = move.squaredNorm() <= far * far;
        }
    }
    keep(kept, points);
}

double spread_out(const Apart& apart, Candidates& points, const Execution& execution) {
    const double reach = std::max(apart.least, apart.wanted);
    double nearest = reach;
    std::vector<bool> kept(points.size(), true);
    std::size_t left = points.size();
    for (const Pair& pair : near_pairs(points.points, reach, execution)) {
        if (!kept[pair.later] || !kept[pair.earlier]) continue;
        if (pair.distance >= reach) break;
        if (pair.distance >= apart.least && left <= apart.enough) {
            nearest = pair.distance;
            break;
        }
        kept[pair.later] = false;
        --left;
    }
    keep(kept, points);
    return nearest;
}

}  // namespace lpf
