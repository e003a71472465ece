#include "core/shape/noise_reading.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace lpf {
namespace {

constexpr std::size_t kFewestForPlane = 8;

/// Of so many balls that lie along a line, the others hold crossings.
constexpr double kMostlyCurves = 0.8;

Eigen::Vector3d mean_of(const NearPoints& ball) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < ball.size; ++i) {
        sum += Eigen::Vector3d(ball.x[i], ball.y[i], ball.z[i]);
    }
    return sum / static_cast<double>(ball.size);
}

/// Whether most of the points of a ball are where its centre is.
bool is_heap(const NearPoints& ball) {
    std::size_t equal = 0;
    for (std::size_t i = 0; i < ball.size; ++i) {
        equal += ball.x[i] == 0 && ball.y[i] == 0 && ball.z[i] == 0;
    }
    return 2 * equal > ball.size;
}

}  // namespace

std::vector<Eigen::Index> SampledCloud::some(std::size_t count) const {
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

double NoiseReading::noise(double deviation, double below) const {
    const double chance = 1 + below / std::sqrt(2 * spread.freedom);
    return radius * uncut(chance * deviation);
}

NoiseReading read_noise(const PointGrid& grid, const Eigen::Vector3d& point, double radius,
                        NoiseScratch& scratch) {
    NearPoints& ball = scratch.ball;
    grid.gather(point, radius, 1.0F, ball);
    if (ball.size < kFewestForPlane || is_heap(ball)) return {};
    // The point is off the shape; the mean of those around it is nearer.
    grid.gather(point + radius * mean_of(ball), radius, 1.0F, ball);
    if (ball.size < kFewestForPlane) return {};
    return {point, radius, spread_in(ball, scratch.heights)};
}

std::vector<NoiseReading> read_noise(const SampledCloud& cloud, const PointGrid& grid,
                                     double radius, std::size_t balls, const Execution& execution) {
    const std::vector<Eigen::Index> chosen = cloud.some(balls);
    std::vector<NoiseReading> readings(chosen.size());
    parallel_for(execution, chosen.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
        NoiseScratch scratch;
        for (std::size_t i = begin; i < end; ++i) {
            readings[i] = read_noise(grid, cloud.points.col(chosen[i]), radius, scratch);
        }
    });
    std::erase_if(readings, [](const NoiseReading& reading) { return reading.radius <= 0; });
    const auto is_curve = [](const NoiseReading& reading) { return reading.spread.is_curve; };
    const auto curves = static_cast<double>(std::ranges::count_if(readings, is_curve));
    if (curves < kMostlyCurves * static_cast<double>(readings.size())) {
        std::erase_if(readings, is_curve);
    }
    return readings;
}

}  // namespace lpf
