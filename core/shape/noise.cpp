#include "core/shape/noise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "core/shape/extent.h"
#include "core/shape/point_grid.h"
#include "core/shape/spread.h"
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

/// A ball larger than this share of the diagonal shows the whole shape, not what it is made of.
constexpr double kLargestBall = 0.25;

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

/// Edges and thin parts add to the spread, so that less than the median is noise. Of balls on a
/// plane, the spread at this quantile lies so many standard deviations below the mean.
constexpr double kQuantile = 0.2;
constexpr double kDeviationsBelow = 0.842;

/// Balls with no more than this times that spread tell whether it is all noise.
constexpr double kNearQuantile = 1.4;

/// Sheets that add a smaller share to the variance cannot be told from the shape of chance.
constexpr double kLeastHidden = 0.33;
constexpr double kMostHidden = 0.8;

/// What the ball around a place of the shape says.
struct Reading {
    double noise = -1.0;  ///< [input length]; less than 0: nothing
    Spread spread;
};

Eigen::Vector3d mean_of(const NearPoints& ball) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < ball.size; ++i) {
        sum += Eigen::Vector3d(ball.x[i], ball.y[i], ball.z[i]);
    }
    return sum / static_cast<double>(ball.size);
}

/// The spread in the smallest ball around a place of the shape that is wide enough for it; nothing
/// where none is: the point is alone, or all around it is thinner than it is rough.
Reading noise_around(const PointGrid& grid, const Eigen::Vector3d& point, double radius,
                     double largest, NearPoints& ball, std::vector<double>& heights) {
    double growth = kGrowth;
    for (int i = 0; i < kMostSteps && radius <= largest; ++i, radius *= growth) {
        growth = kGrowth;
        grid.gather(point, radius, 1.0F, ball);
        if (ball.size < kFewestForPlane) continue;
        double wanted = kSigmasInBall * spread_in(ball, heights).deviation;
        if (wanted <= kNearlyWide) {
            // The point is off the shape; the mean of those around it is nearer.
            grid.gather(point + radius * mean_of(ball), radius, 1.0F, ball);
            if (ball.size < kFewestForPlane) continue;
            const Spread spread = spread_in(ball, heights);
            wanted = kSigmasInBall * spread.deviation;
            if (wanted <= 1) {
                const double chance = 1 + kDeviationsBelow / std::sqrt(2 * spread.points);
                return {radius * uncut_deviation(spread) * chance, spread};
            }
        }
        growth = std::clamp(kShareOfStep * wanted, kGrowth, kMostGrowth);
    }
    return {};
}

/// How much of the variance is not noise but two sheets that it hides, by the shape of what lies
/// off the plane: the kurtosis of noise is 3, that of two sheets with the share s is 3 - 2 s^2.
double share_of_hidden_sheets(const std::vector<Reading>& readings, double deviation) {
    double sum = 0.0;
    double count = 0.0;
    for (const Reading& reading : readings) {
        if (reading.spread.is_parted || reading.noise > kNearQuantile * deviation) continue;
        sum += reading.spread.kurtosis;
        count += 1;
    }
    const double share = count > 0 ? std::sqrt(std::max(0.0, 3 - sum / count) / 2) : 0.0;
    return share < kLeastHidden ? 0.0 : std::min(share, kMostHidden);
}

/// A low quantile over a sample of the points, each in a ball of its own.
double noise_of(const Sampled& cloud, const PointGrid& grid, double radius, double largest,
                const Execution& execution) {
    const std::vector<Eigen::Index> chosen = cloud.some(kNoiseSample);
    std::vector<Reading> readings(chosen.size());
    parallel_for(execution, chosen.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
        NearPoints ball;
        std::vector<double> heights;
        for (std::size_t i = begin; i < end; ++i) {
            readings[i] =
                noise_around(grid, cloud.points.col(chosen[i]), radius, largest, ball, heights);
        }
    });
    std::erase_if(readings, [](const Reading& reading) { return reading.noise < 0; });
    std::vector<double> deviations;
    for (const Reading& reading : readings) deviations.push_back(reading.noise);
    const double deviation = quantile(deviations, kQuantile);
    return deviation * std::sqrt(1 - share_of_hidden_sheets(readings, deviation));
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
