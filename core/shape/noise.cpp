#include "core/shape/noise.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/shape/extent.h"
#include "core/shape/point_grid.h"
#include "core/shape/tiling.h"

namespace lpf {
namespace {

constexpr std::size_t kSpacingSample = 4096;
constexpr std::size_t kNoiseSample = 400;
constexpr std::size_t kPointsInBall = 150;
constexpr int kMostDoublings = 32;    // from a cell to the whole shape
constexpr double kPointsInCell = 40;  // of the grid that they are looked for in, at most
constexpr std::size_t kFewestForPlane = 8;

/// Points of the first ball that the noise is looked for in.
constexpr std::size_t kPointsInSmallBall = 24;

/// A ball narrower than this many sigma cuts the noise off and makes it look smaller than it is.
/// The smallest ball that is wide enough tells noise from shape: what curves at its scale is shape.
constexpr double kSigmasInBall = 4.0;
constexpr double kGrowth = 1.2;
constexpr double kMostGrowth = 1.4;
constexpr int kMostSteps = 1000;      // coordinates may be as large as numbers go
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

/// A cloud that is not in memory is measured in so many boxes of about so many points each, with
/// all around them within so many radii and sigma, which a look at a few larger ones tells.
constexpr std::size_t kBoxes = 256;
constexpr double kPointsInBox = 512;
constexpr std::size_t kRoughBoxes = 16;
constexpr double kPointsInRoughBox = 8192;
constexpr double kRadiiAround = 1.5;
constexpr double kSigmasAround = 6.0;

double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0.0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

double median(std::vector<double>& values) { return quantile(values, 0.5); }

/// A cloud, and those of its points that all others near them belong to; empty: it is whole.
struct Sampled {
    const Points& points;
    std::vector<Eigen::Index> complete = {};

    /// Up to `count` of them spread over the cloud, the same for every run.
    [[nodiscard]] std::vector<Eigen::Index> some(std::size_t count) const {
        const std::size_t n =
            complete.empty() ? static_cast<std::size_t>(points.cols()) : complete.size();
        std::vector<Eigen::Index> chosen;
        Random random(n, 0x3e45);
        for (std::size_t i = 0; i < std::min(n, count); ++i) {
            const std::size_t k = n <= count ? i : random.below(n);
            chosen.push_back(complete.empty() ? static_cast<Eigen::Index>(k) : complete[k]);
        }
        return chosen;
    }
};

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
/// sides of something thin [radius of the ball].
double spread_off_plane(const NearPoints& ball, std::vector<double>& heights) {
    // A large ball is thinned: its covariance is as good from a few thousand points.
    const std::size_t stride = 1 + ball.size / kMostInBall;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double count = 0;
    for (std::size_t i = 0; i < ball.size; i += stride, ++count) {
        const Eigen::Vector3d p(ball.x[i], ball.y[i], ball.z[i]);
        mean += p;
        squares += p * p.transpose();
    }
    mean /= count;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(squares / count - mean * mean.transpose());
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    const double offset = normal.dot(mean);
    heights.clear();
    for (std::size_t i = 0; i < ball.size; i += stride) {
        heights.push_back(normal.dot(Eigen::Vector3d(ball.x[i], ball.y[i], ball.z[i])) - offset);
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

double undo_cuts(double share, std::size_t points) {
    const double counted = static_cast<double>(std::min(points, kMostInBall));
    return share * (1 + kCutOff * share * share) * (1 + kDeviationsBelow / std::sqrt(2 * counted));
}

Eigen::Vector3d mean_of(const NearPoints& ball) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < ball.size; ++i) {
        sum += Eigen::Vector3d(ball.x[i], ball.y[i], ball.z[i]);
    }
    return sum / static_cast<double>(ball.size);
}

/// The spread in the smallest ball around a place of the shape that is wide enough for it; less
/// than 0 where none is: the point is alone, or all around it is thinner than it is rough.
double noise_around(const PointGrid& grid, const Eigen::Vector3d& point, double radius,
                    double largest, NearPoints& ball, std::vector<double>& heights) {
    double growth = kGrowth;
    for (int i = 0; i < kMostSteps && radius <= largest; ++i, radius *= growth) {
        growth = kGrowth;
        grid.gather(point, radius, 1.0F, ball);
        if (ball.size < kFewestForPlane) continue;
        double wanted = kSigmasInBall * spread_off_plane(ball, heights);
        if (wanted <= kNearlyWide) {
            // The point is off the shape; the mean of those around it is nearer.
            grid.gather(point + radius * mean_of(ball), radius, 1.0F, ball);
            if (ball.size < kFewestForPlane) continue;
            const double share = spread_off_plane(ball, heights);
            wanted = kSigmasInBall * share;
            if (wanted <= 1) return radius * undo_cuts(share, ball.size);
        }
        growth = std::clamp(kShareOfStep * wanted, kGrowth, kMostGrowth);
    }
    return -1.0;
}

/// A low quantile over a sample of the points, each in a ball of its own.
double noise_of(const Sampled& cloud, const PointGrid& grid, double radius, double largest,
                const Execution& execution) {
    const std::vector<Eigen::Index> chosen = cloud.some(kNoiseSample);
    std::vector<double> spreads(chosen.size(), -1.0);
    parallel_for(execution, chosen.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
        NearPoints ball;
        std::vector<double> heights;
        for (std::size_t i = begin; i < end; ++i) {
            spreads[i] =
                noise_around(grid, cloud.points.col(chosen[i]), radius, largest, ball, heights);
        }
    });
    std::erase(spreads, -1.0);
    return quantile(spreads, kQuantile);
}

/// Distances of a point to those around it [input length].
struct Surroundings {
    double nearest = -1.0;  ///< to the nearest other position; less than 0: there is none near
    double small = 0.0;     ///< to the point that fills the small ball
    double full = 0.0;      ///< to the one that fills the ball
};

Surroundings surroundings(const PointGrid& grid, const Eigen::Vector3d& point, double radius,
                          std::size_t points_in_ball, NearPoints& ball,
                          std::vector<float>& squared) {
    grid.gather(point, radius, 1.0F, ball);
    for (int i = 0; i < kMostDoublings && ball.size < points_in_ball; ++i) {
        radius *= 2;
        grid.gather(point, radius, 1.0F, ball);
    }
    squared.resize(ball.size);
    for (std::size_t i = 0; i < ball.size; ++i) {
        squared[i] = ball.x[i] * ball.x[i] + ball.y[i] * ball.y[i] + ball.z[i] * ball.z[i];
    }
    const std::size_t k = std::min(points_in_ball, ball.size);
    std::partial_sort(squared.begin(), squared.begin() + static_cast<std::ptrdiff_t>(k),
                      squared.end());
    squared.resize(k);
    const auto other = std::ranges::find_if(squared, [](float distance) { return distance > 0; });
    if (other == squared.end()) return {};  // one of many duplicates
    const std::size_t small = std::min(kPointsInSmallBall, k) - 1;
    return {radius * std::sqrt(static_cast<double>(*other)),
            radius * std::sqrt(static_cast<double>(squared[small])),
            radius * std::sqrt(static_cast<double>(squared.back()))};
}

/// Distances to the nearest other position, and to the point that makes the ball full.
/// @param cell of the grid
/// @returns the median radius of the smallest ball to look for noise in
double measure_spacing(const Sampled& cloud, const PointGrid& grid, double cell,
                       Measurements& result, const Execution& execution) {
    const std::vector<Eigen::Index> chosen = cloud.some(kSpacingSample);
    const std::size_t k = std::min(kPointsInBall, result.points);
    std::vector<Surroundings> around(chosen.size());
    parallel_for(
        execution, chosen.size(), 64, [&](std::size_t begin, std::size_t end, std::size_t) {
            NearPoints ball;
            std::vector<float> squared;
            for (std::size_t i = begin; i < end; ++i) {
                around[i] =
                    surroundings(grid, cloud.points.col(chosen[i]), 1.5 * cell, k, ball, squared);
            }
        });
    std::erase_if(around, [](const Surroundings& s) { return s.nearest < 0; });
    result.mean_spacing = result.density_radius = result.diagonal;
    if (around.empty()) return result.diagonal;
    std::vector<double> full;
    std::vector<double> small;
    double sum = 0.0;
    for (const Surroundings& s : around) {
        sum += s.nearest;
        full.push_back(s.full);
        small.push_back(s.small);
    }
    result.mean_spacing = sum / static_cast<double>(around.size());
    result.density_radius = median(full);
    // Of points that lie on each other by the dozen, the small ball has no radius.
    const double radius = median(small);
    return radius > 0 ? radius : result.mean_spacing;
}

Measurements measure(const Sampled& cloud, const Execution& execution) {
    const Points& points = cloud.points;
    Measurements result;
    result.points = static_cast<std::size_t>(points.cols());
    check_number_of_points(result.points);
    result.diagonal = (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
    check_extent(result.diagonal);
    const double cell = cell_of_some_points(points, kPointsInCell);
    const PointGrid grid(points, cell, execution);
    const double radius = measure_spacing(cloud, grid, cell, result, execution);
    result.noise =
        noise_of(cloud, grid, radius, std::max(radius, kLargestBall * result.diagonal), execution);
    return result;
}

/// Measures in and around the boxes of an excerpt.
Measurements measure(const PointSource& source, const Excerpt& excerpt,
                     const Execution& execution) {
    Points points;
    source.read(excerpt.points, points);
    source.let_go();
    Sampled cloud{points};
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (distance_to(excerpt.boxes, points.col(i)) <= 0) cloud.complete.push_back(i);
    }
    return measure(cloud, execution);
}

}  // namespace

Measurements measure(const Points& points, const Execution& execution) {
    return measure(Sampled{points}, execution);
}

Measurements measure(const PointSource& source, const Execution& execution) {
    const Sketch sketch = make_sketch(source, execution);
    const auto measure_in = [&](std::size_t boxes, double points, double around) {
        const Partition partition(sketch, points);
        const Excerpt excerpt = make_excerpt(source, partition, boxes, around, execution);
        return measure(source, excerpt, execution);
    };
    const Measurements rough = measure_in(kRoughBoxes, kPointsInRoughBox, 0.0);
    const double around =
        std::max(kRadiiAround * rough.density_radius, kSigmasAround * rough.noise);
    Measurements result = measure_in(kBoxes, kPointsInBox, around);
    result.points = sketch.of;
    result.diagonal = (sketch.high - sketch.low).norm();
    return result;
}

}  // namespace lpf
