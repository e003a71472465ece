#include "core/shape/noise_variation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/shape/hidden_sheets.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr std::size_t kBalls = 1200;

/// The noise of a place is a low quantile in so many balls about it: edges and thin parts add to
/// the spread. Chance alone puts it so many deviations below the mean.
constexpr std::size_t kBallsNear = 16;
constexpr double kQuantile = 0.25;
constexpr double kDeviationsBelow = 0.674;

/// Balls are as wide as so many sigma at least, or as large as they may be.
constexpr double kSigmasInBall = 3.0;
constexpr double kGrowth = 1.3;

/// Noise varies where its upper tenth is so many times its lower one.
constexpr double kVaries = 2.0;

/// Nothing more is known about a place where there is so little [usual noise], or so much.
constexpr double kLeastFactor = 0.05;
constexpr double kMostFactor = 8.0;

using Readings = std::vector<NoiseReading>;
using Numbers = std::vector<std::uint32_t>;

Points places_of(const Readings& readings) {
    Points places(3, static_cast<Eigen::Index>(readings.size()));
    for (std::size_t i = 0; i < readings.size(); ++i) {
        places.col(static_cast<Eigen::Index>(i)) = readings[i].place;
    }
    return places;
}

/// Which balls are near each of the balls.
std::vector<Numbers> neighbourhoods(const Points& places) {
    const SpatialIndex index(places);
    std::vector<Numbers> all;
    std::vector<SpatialIndex::Neighbour> near;
    for (const auto place : places.colwise()) {
        index.nearest(place, kBallsNear, near);
        all.emplace_back();
        for (const auto& neighbour : near) all.back().push_back(neighbour.index);
    }
    return all;
}

bool vary(std::vector<double> noises, double least) {
    const double low = quantile(noises, 0.1);
    const double high = quantile(noises, 0.9);
    return high > std::max(least, kVaries * low);
}

double noise_by(const NoiseReading& reading, double Spread::*deviation) {
    return reading.noise(reading.spread.*deviation, kDeviationsBelow);
}

/// Whether the noise about the balls varies, by one of the deviations of their spreads.
bool seems_to_vary(const Readings& readings, const std::vector<Numbers>& near,
                   double Spread::*deviation, double least) {
    std::vector<double> noises;
    for (const Numbers& numbers : near) {
        std::vector<double> values;
        for (const std::uint32_t i : numbers) values.push_back(noise_by(readings[i], deviation));
        noises.push_back(quantile(values, kQuantile));
    }
    return vary(std::move(noises), least);
}

/// A ball at a place that is wide enough for its noise, by how much the heights of neighbours
/// differ: in that, detail makes no difference.
struct Look {
    NoiseReading reading;
    double between = 0.0;  ///< [input length]
};

Look look_at(const PointGrid& grid, const NoiseReading& first, double largest,
             NoiseScratch& scratch) {
    Look look{first};
    for (double radius = first.radius;; radius *= kGrowth) {
        const NoiseReading now = read_noise(grid, first.place, radius, scratch);
        if (now.radius <= 0) return look;
        look.reading = now;
        const double deviation = deviation_between_neighbours(scratch.ball, scratch.heights);
        look.between = look.reading.noise(deviation, kDeviationsBelow);
        if (kSigmasInBall * look.between <= radius || kGrowth * radius > largest) return look;
    }
}

std::vector<Look> look_closely(const PointGrid& grid, const Readings& readings, double largest,
                               const Execution& execution) {
    std::vector<Look> looks(readings.size());
    parallel_for(execution, looks.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
        NoiseScratch scratch;
        for (std::size_t i = begin; i < end; ++i) {
            looks[i] = look_at(grid, readings[i], largest, scratch);
        }
    });
    return looks;
}

/// The noise of a place by the balls near it, without two sheets that they hold.
double noise_about(const Numbers& near, const std::vector<Look>& looks) {
    std::vector<Spread> spreads;
    for (const std::uint32_t i : near) spreads.push_back(looks[i].reading.spread);
    const HiddenSheets sheets = find_hidden_sheets(spreads);
    std::vector<double> noises;
    for (const std::uint32_t i : near) {
        const auto& [reading, between] = looks[i];
        const bool is_parted = sheets.are_parted && reading.spread.is_parted;
        noises.push_back(is_parted ? std::min(between, noise_by(reading, &Spread::deviation)) : between);
    }
    return std::sqrt(1 - sheets.share) * quantile(noises, kQuantile);
}

}  // namespace

std::optional<NoiseVariation> find_noise_variation(const SampledCloud& cloud, const PointGrid& grid,
                                                   const NoiseSearch& search,
                                                   const Execution& execution) {
    const Readings readings = read_noise(cloud, grid, search.radius, kBalls, execution);
    if (readings.size() < kBallsNear) return std::nullopt;
    const Points places = places_of(readings);
    const std::vector<Numbers> near = neighbourhoods(places);
    // Where sheets part or meet, one of the two does not vary.
    if (!seems_to_vary(readings, near, &Spread::deviation, search.least) ||
        !seems_to_vary(readings, near, &Spread::whole, search.least)) {
        return std::nullopt;
    }
    const std::vector<Look> looks = look_closely(grid, readings, search.largest, execution);
    std::vector<double> noises;
    for (const Numbers& numbers : near) noises.push_back(noise_about(numbers, looks));
    if (!vary(noises, search.least)) return std::nullopt;
    const double usual = std::accumulate(noises.begin(), noises.end(), 0.0) /
                         static_cast<double>(noises.size());
    for (double& noise : noises) noise = std::clamp(noise / usual, kLeastFactor, kMostFactor);
    return NoiseVariation{usual, NoiseMap(places, std::move(noises))};
}

}  // namespace lpf
