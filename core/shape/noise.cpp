#include "core/shape/noise.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "core/shape/extent.h"
#include "core/shape/hidden_sheets.h"
#include "core/shape/noise_reading.h"
#include "core/shape/noise_variation.h"
#include "core/shape/point_grid.h"
#include "core/shape/quantile.h"
#include "core/shape/spread.h"
#include "core/shape/tiling.h"

namespace lpf {
namespace {

constexpr std::size_t kSpacingSample = 4096;
constexpr std::size_t kPointsInBall = 150;
constexpr int kMostDoublings = 32;    // from a cell to the whole shape
constexpr double kPointsInCell = 40;  // of the grid that they are looked for in, at most

/// Points of the first balls that the noise is looked for in.
constexpr std::size_t kPointsInSmallBall = 50;

/// Balls are looked at until they hold so many points in all: small ones say little each.
constexpr double kPointsToLookAt = 60000;
constexpr double kFewestBalls = 400;
constexpr double kMostBalls = 1600;

/// Of a ball narrower than this many sigma, nobody can say how much of the noise it cuts off. The
/// smallest balls that are wide enough tell noise from shape: what bends at their scale is shape.
constexpr double kSigmasInBall = 3.0;
constexpr double kGrowth = 1.1;
constexpr double kMostGrowth = 1.4;
constexpr int kMostSteps = 1000;      // coordinates may be as large as numbers go
constexpr double kShareOfStep = 0.9;  // of the way to the balls that the spread asks for

/// What is this much wider shows hidden sheets, and how much the bends of the shape add to noise:
/// what a quadric leaves of them grows with the cube of the width.
constexpr double kWider = 4.0 / 3;
constexpr double kBentShare = 1 / (kWider * kWider * kWider - 1);

/// More than this share of what was found is no bend, but another part of the shape.
constexpr double kMostBent = 0.3;

/// A ball larger than this share of the diagonal shows the whole shape, not what it is made of.
constexpr double kLargestBall = 0.25;

/// What varies by less than this share of the spacing may be detail of a shape without noise.
constexpr double kLeastVaried = 0.5;

/// A cloud that is not in memory is measured in so many boxes of about so many points each, with
/// all around them within so many radii and sigma, which a look at a few larger ones tells.
constexpr std::size_t kBoxes = 256;
constexpr double kPointsInBox = 512;
constexpr std::size_t kRoughBoxes = 16;
constexpr double kPointsInRoughBox = 8192;
constexpr double kRadiiAround = 1.5;
constexpr double kSigmasAround = 6.0;

/// Edges and thin parts add to the spread, so that less than the median is noise. Of balls on a
/// plane, the spread at this quantile lies so many standard deviations below the mean.
constexpr double kQuantile = 0.1;
constexpr double kDeviationsBelow = 1.282;

/// Balls with no more than this times that spread tell whether it is all noise.
constexpr double kNearQuantile = 1.2;

using Readings = std::vector<NoiseReading>;

/// The noise at a low quantile, by one of the deviations of the spreads.
double low_quantile(const Readings& readings, double Spread::*deviation) {
    std::vector<double> values;
    values.reserve(readings.size());
    for (const NoiseReading& reading : readings) {
        values.push_back(reading.noise(reading.spread.*deviation, kDeviationsBelow));
    }
    return quantile(values, kQuantile);
}

/// The spreads that are no wider than noise is, or two sheets that it hides.
std::vector<Spread> low_spreads(const Readings& readings) {
    const double limit = kNearQuantile * low_quantile(readings, &Spread::whole);
    std::vector<Spread> spreads;
    for (const NoiseReading& reading : readings) {
        if (reading.noise(reading.spread.whole, kDeviationsBelow) <= limit) {
            spreads.push_back(reading.spread);
        }
    }
    return spreads;
}

struct NoiseLevel {
    double noise = 0.0;
    Readings readings = {};  ///< that it was found in
};

/// A low quantile over a sample of the points, in the smallest balls that are wide enough for it;
/// 0 where none are: all is thinner than it is rough.
/// @param radius   of the smallest balls that may do
/// @param measured tells how dense the cloud is, and how large
NoiseLevel noise_of(const SampledCloud& cloud, const PointGrid& grid, double radius,
                    const Measurements& measured, const Execution& execution) {
    const auto read = [&](double size) {
        const double share = size / measured.density_radius;
        const double balls = kPointsToLookAt / (kPointsInBall * share * share);
        const double some = std::clamp(balls, kFewestBalls, kMostBalls);
        return read_noise(cloud, grid, size, static_cast<std::size_t>(some), execution);
    };
    const double largest = std::max(radius, kLargestBall * measured.diagonal);
    auto deviation = &Spread::deviation;
    for (int i = 0; i < kMostSteps && radius <= largest; ++i) {
        Readings readings = read(radius);
        const double noise = low_quantile(readings, deviation);
        const double wanted = kSigmasInBall * noise / radius;
        if (readings.empty() || wanted > 1) {
            radius *= std::clamp(kShareOfStep * wanted, kGrowth, kMostGrowth);
            continue;
        }
        const Readings wider = read(kWider * radius);
        const HiddenSheets hidden = find_hidden_sheets(low_spreads(wider));
        if (hidden.is_flat_noise && deviation == &Spread::deviation) {
            deviation = &Spread::whole;  // what looked like two sheets is none
            continue;
        }
        const double more = low_quantile(wider, deviation);
        const double bends = std::clamp(kBentShare * (more - noise), 0.0, kMostBent * noise);
        const double without_sheets =
            low_quantile(wider, &Spread::whole) * std::sqrt(1 - hidden.share);
        return {std::min({noise - bends, more, without_sheets}), std::move(readings)};
    }
    return {};
}

/// Distances of a point to those around it [input length].
struct Surroundings {
    double nearest = -1.0;  ///< to the nearest other position; less than 0: there is none near
    double small = 0.0;     ///< to the point that fills the small ball
    double full = 0.0;      ///< to the one that fills the ball
};

/// Brings the least of some values to the front. @returns how many these are, `count` at most
std::ptrdiff_t keep_least(std::vector<float>& values, std::size_t count) {
    const auto kept = static_cast<std::ptrdiff_t>(std::min(count, values.size()));
    if (kept < std::ssize(values))
        std::nth_element(values.begin(), values.begin() + kept, values.end());
    return kept;
}

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
    squared.resize(static_cast<std::size_t>(keep_least(squared, points_in_ball)));
    const float full = std::ranges::max(squared);
    float other = std::numeric_limits<float>::infinity();
    for (const float distance : squared) other = distance > 0 ? std::min(distance, other) : other;
    if (other > full) return {};  // one of many duplicates
    const std::ptrdiff_t few = keep_least(squared, kPointsInSmallBall);
    const float small = *std::max_element(squared.begin(), squared.begin() + few);
    const auto length = [radius](float of) { return radius * std::sqrt(static_cast<double>(of)); };
    return {length(other), length(small), length(full)};
}

/// Distances to the nearest other position, and to the point that makes the ball full.
/// @param cell of the grid
/// @returns the median radius of the smallest ball to look for noise in
double measure_spacing(const SampledCloud& cloud, const PointGrid& grid, double cell,
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

Measurements measure(const SampledCloud& cloud, const Execution& execution) {
    const Points& points = cloud.points;
    Measurements result;
    result.points = static_cast<std::size_t>(points.cols());
    check_number_of_points(result.points);
    result.diagonal = bounding_box(points, execution).sizes().norm();
    check_extent(result.diagonal);
    const double cell = cell_of_some_points(points, kPointsInCell, execution);
    const PointGrid grid(points, cell, execution);
    const double radius = measure_spacing(cloud, grid, cell, result, execution);
    const NoiseLevel level = noise_of(cloud, grid, radius, result, execution);
    result.noise = level.noise;
    auto variation = find_noise_variation(level.readings, cloud, grid,
                                          {.lowest = level.noise,
                                           .least = kLeastVaried * result.mean_spacing,
                                           .largest_ball = kLargestBall * result.diagonal},
                                          execution);
    if (!variation) return result;
    result.noise = variation->usual;
    result.noise_map = std::move(variation->map);
    return result;
}

/// Measures in and around the boxes of an excerpt.
Measurements measure(const PointSource& source, const Excerpt& excerpt,
                     const Execution& execution) {
    Points points;
    source.read(excerpt.points, points);
    source.let_go();
    SampledCloud cloud{points};
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (distance_to(excerpt.boxes, points.col(i)) <= 0) cloud.complete.push_back(i);
    }
    return measure(cloud, execution);
}

}  // namespace

Measurements measure(const Points& points, const Execution& execution) {
    return measure(SampledCloud{points}, execution);
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
