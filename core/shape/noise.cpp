#include "core/shape/noise.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr std::size_t kSpacingSample = 4096;
constexpr std::size_t kNoiseSample = 400;
constexpr std::size_t kPointsInBall = 150;
constexpr std::size_t kFewestForPlane = 8;

/// Points of the first ball that the noise is looked for in.
constexpr std::size_t kPointsInSmallBall = 24;

/// A ball narrower than this many sigma cuts the noise off and makes it look smaller than it is.
/// The smallest ball that is wide enough tells noise from shape: what curves at its scale is shape.
constexpr double kSigmasInBall = 4.0;
constexpr double kGrowth = 1.2;
constexpr double kMostGrowth = 1.4;
constexpr double kShareOfStep = 0.9;  // of the way to the ball that the spread asks for
constexpr double kNearlyWide = 1.1;

/// Two sheets leave less than this share of the variance when they are told apart; an even block
/// leaves .25, noise alone .36, what a ball cuts out of noise .30.
constexpr double kTwoSheets = 0.23;
constexpr int kSplitRounds = 4;
constexpr double kFewestForTwo = 50;  // of fewer points, chance makes two groups

/// A ball larger than this share of the diagonal shows the whole shape, not what it is made of.
constexpr double kLargestBall = 0.25;
constexpr std::size_t kMostInBall = 3000;

double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

double median(std::vector<double>& values) { return quantile(values, 0.5); }

/// Up to `count` points spread over the cloud, the same for every run.
std::vector<Eigen::Index> sample(const Points& points, std::size_t count) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<Eigen::Index> chosen;
    Random random(n, 0x3e45);
    for (std::size_t i = 0; i < std::min(n, count); ++i) {
        chosen.push_back(static_cast<Eigen::Index>(n <= count ? i : random.below(n)));
    }
    return chosen;
}

/// The variance within two groups of heights, split where it is least (2-means from the mean).
double variance_of_two(const std::vector<double>& heights) {
    double split = 0.0;
    double within = 0.0;
    for (int round = 0; round < kSplitRounds; ++round) {
        double count[2] = {0, 0};
        double sum[2] = {0, 0};
        double squares = 0.0;
        for (const double h : heights) {
            count[h > split] += 1;
            sum[h > split] += h;
            squares += h * h;
        }
        if (count[0] == 0 || count[1] == 0) break;
        split = (sum[0] / count[0] + sum[1] / count[1]) / 2;
        within = (squares - sum[0] * sum[0] / count[0] - sum[1] * sum[1] / count[1]) /
                 (count[0] + count[1]);
    }
    return std::max(0.0, within);
}

/// The spread off the best plane; off the nearer of two parallel ones where the ball holds both
/// sides of something thin.
double spread_off_plane(const Points& points, const std::vector<SpatialIndex::Neighbour>& ball) {
    // A large ball is thinned: its covariance is as good from a few thousand points.
    const std::size_t stride = 1 + ball.size() / kMostInBall;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    const Eigen::Vector3d origin = points.col(ball.front().index);
    double count = 0;
    for (std::size_t i = 0; i < ball.size(); i += stride, ++count) {
        const Eigen::Vector3d p = points.col(ball[i].index) - origin;
        mean += p;
        squares += p * p.transpose();
    }
    mean /= count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(squares / count - mean * mean.transpose());
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    std::vector<double> heights;
    for (std::size_t i = 0; i < ball.size(); i += stride) {
        heights.push_back(normal.dot(points.col(ball[i].index) - origin - mean));
    }
    // Three degrees of freedom went into the plane.
    const double unbiased = count / std::max(1.0, count - 3);
    const double whole = std::max(0.0, solver.eigenvalues()[0]);
    const double parted = count < kFewestForTwo ? whole : variance_of_two(heights);
    return std::sqrt(unbiased * (parted < kTwoSheets * whole ? parted : whole));
}

/// A ball cuts off what noise carries beyond it: the spread in one of radius R is too small by
/// about this much times (spread / R)^2.
constexpr double kCutOff = 1.9;

/// Edges and thin parts add to the spread, so that less than the median is noise. Of balls on a
/// plane, the spread at this quantile lies so many standard deviations below the mean.
constexpr double kQuantile = 0.2;
constexpr double kDeviationsBelow = 0.842;

double undo_cuts(double spread, double radius, std::size_t points) {
    const double share = spread / radius;
    const double counted = static_cast<double>(std::min(points, kMostInBall));
    return spread * (1 + kCutOff * share * share) * (1 + kDeviationsBelow / std::sqrt(2 * counted));
}

Eigen::Vector3d mean_of(const Points& points, const std::vector<SpatialIndex::Neighbour>& ball) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const SpatialIndex::Neighbour& neighbour : ball) sum += points.col(neighbour.index);
    return sum / static_cast<double>(ball.size());
}

/// The spread in the smallest ball around a place of the shape that is wide enough for it; less
/// than 0 where none is: the point is alone, or all around it is thinner than it is rough.
double noise_around(const Points& points, const SpatialIndex& index, Eigen::Index i, double radius,
                    double largest, std::vector<SpatialIndex::Neighbour>& ball) {
    double growth = kGrowth;
    for (; radius <= largest; radius *= growth) {
        growth = kGrowth;
        index.within(points.col(i), radius, ball);
        if (ball.size() < kFewestForPlane) continue;
        double wanted = kSigmasInBall * spread_off_plane(points, ball) / radius;
        if (wanted <= kNearlyWide) {
            // The point is off the shape; the mean of those around it is nearer.
            index.within(mean_of(points, ball), radius, ball);
            if (ball.size() < kFewestForPlane) continue;
            const double spread = spread_off_plane(points, ball);
            wanted = kSigmasInBall * spread / radius;
            if (wanted <= 1) return undo_cuts(spread, radius, ball.size());
        }
        growth = std::clamp(kShareOfStep * wanted, kGrowth, kMostGrowth);
    }
    return -1.0;
}

/// A low quantile over a sample of the points, each in a ball of its own.
double noise_of(const Points& points, const SpatialIndex& index, double radius, double largest,
                const Execution& execution) {
    const std::vector<Eigen::Index> chosen = sample(points, kNoiseSample);
    std::vector<double> spreads(chosen.size(), -1.0);
    parallel_for(execution, chosen.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
        std::vector<SpatialIndex::Neighbour> ball;
        for (std::size_t i = begin; i < end; ++i) {
            spreads[i] = noise_around(points, index, chosen[i], radius, largest, ball);
        }
    });
    std::erase(spreads, -1.0);
    return quantile(spreads, kQuantile);
}

/// Distances to the nearest other position, and to the point that makes the ball full.
/// @returns the median radius of the smallest ball to look for noise in
double measure_spacing(const Points& points, const SpatialIndex& index, Measurements& result,
                       const Execution& execution) {
    std::vector<double> full;
    std::vector<double> small;
    double sum = 0.0;
    std::size_t counted = 0;
    const std::size_t k = std::min(kPointsInBall, result.points);
    for (const Eigen::Index i : sample(points, kSpacingSample)) {
        throw_if_cancelled(execution);
        const auto neighbours = index.nearest(points.col(i), k);
        const auto other = std::ranges::find_if(
            neighbours, [](const auto& neighbour) { return neighbour.squared_distance > 0; });
        if (other == neighbours.end()) continue;  // one of many duplicates
        sum += std::sqrt(other->squared_distance);
        full.push_back(std::sqrt(neighbours.back().squared_distance));
        small.push_back(std::sqrt(
            neighbours[std::min(kPointsInSmallBall, neighbours.size()) - 1].squared_distance));
        ++counted;
    }
    result.mean_spacing = counted ? sum / static_cast<double>(counted) : result.diagonal;
    result.density_radius = counted ? median(full) : result.diagonal;
    return counted ? median(small) : result.diagonal;
}

}  // namespace

Measurements measure(const Points& points, const Execution& execution) {
    Measurements result;
    result.points = static_cast<std::size_t>(points.cols());
    if (result.points < 3) {
        throw Error(ErrorCode::TooFewPoints, "The shape has " + std::to_string(result.points) +
                                                 " points; at least 3 are needed.");
    }
    result.diagonal = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
    if (!(result.diagonal > 0)) {
        throw Error(ErrorCode::DegenerateShape,
                    "All points of the shape coincide: it has no extent.");
    }
    const SpatialIndex index(points, execution);
    const double radius = measure_spacing(points, index, result, execution);
    result.noise = noise_of(points, index, radius, std::max(radius, kLargestBall * result.diagonal),
                            execution);
    return result;
}

}  // namespace lpf
