#include "core/shape/noise_variation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/shape/hidden_sheets.h"
#include "core/shape/quantile.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr std::size_t kBalls = 1600;  // that are looked at closely

/// The noise of a place is a low quantile in so many balls about it: edges and thin parts add to
/// the spread. Chance alone puts it so many deviations below the mean.
constexpr std::size_t kBallsNear = 16;
constexpr double kQuantile = 0.25;
constexpr double kDeviationsBelow = 0.674;

/// Balls are as wide as so many sigma at least, or as large as they may be.
constexpr double kSigmasInBall = 3.0;
constexpr double kGrowth = 1.3;

/// A ball so much wider holds no more than so many times the noise.
constexpr double kWider = 1.6;
constexpr double kMostMore = 1.4;

/// Of a shape that scatters itself, fewer of the balls show noise: about it nothing is known.
constexpr double kLeastSeen = 0.5;

/// Noise varies where its upper tenth is so many times its lower one.
constexpr double kVaries = 2.0;

/// Nothing more is known about a place where there is so little [usual noise], or so much.
constexpr double kLeastFactor = 0.05;
constexpr double kMostFactor = 8.0;

using Readings = std::vector<NoiseReading>;
using Numbers = std::vector<std::uint32_t>;

template <typename T, typename PlaceOf>
Points places_of(const std::vector<T>& all, const PlaceOf& place_of) {
    Points places(3, static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
        places.col(static_cast<Eigen::Index>(i)) = place_of(all[i]);
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
bool varies_by(double Spread::*deviation, const Readings& readings,
               const std::vector<Numbers>& neighbourhoods, double least) {
    std::vector<double> noises;
    for (const Numbers& near : neighbourhoods) {
        std::vector<double> values;
        for (const std::uint32_t i : near) values.push_back(noise_by(readings[i], deviation));
        noises.push_back(quantile(values, kQuantile));
    }
    return vary(std::move(noises), least);
}

bool seems_to_vary(const Readings& readings, double least) {
    if (readings.size() < kBallsNear) return false;
    const auto near = neighbourhoods(
        places_of(readings, [](const NoiseReading& reading) { return reading.place; }));
    // Where sheets part or meet, one of the two does not vary.
    return varies_by(&Spread::deviation, readings, near, least) &&
           varies_by(&Spread::whole, readings, near, least);
}

/// A ball at a place that is wide enough for its noise, by how much the heights of neighbours
/// differ: in that, detail makes no difference.
struct Look {
    NoiseReading reading;
    double between = 0.0;  ///< [input length]
};

/// Looks closely, ball by ball.
class Looking {
public:
    Looking(const Readings& readings, const PointGrid& grid, double largest_ball)
        : grid_(grid), radius_(readings.front().radius), largest_(largest_ball) {
        const auto is_curve = [](const NoiseReading& reading) { return reading.spread.is_curve; };
        const auto curves = static_cast<std::size_t>(std::ranges::count_if(readings, is_curve));
        of_curves_ = 2 * curves > readings.size();
    }

    /// Where there is noise to see, of some points.
    [[nodiscard]] std::vector<Look> run(const SampledCloud& cloud,
                                        const std::vector<Eigen::Index>& points,
                                        const Execution& execution) const {
        std::vector<std::optional<Look>> looks(points.size());
        parallel_for(execution, looks.size(), 4,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         NoiseScratch scratch;
                         for (std::size_t i = begin; i < end; ++i) {
                             looks[i] = look_at(cloud.points.col(points[i]), scratch);
                         }
                     });
        std::vector<Look> seen;
        for (const auto& look : looks) {
            if (look) seen.push_back(*look);
        }
        return seen;
    }

private:
    /// Nothing where the shape itself scatters: in what is thinner than a ball, as a twig, and what
    /// fills space, as leaves, there is the more of it the wider the ball.
    [[nodiscard]] std::optional<Look> look_at(const Eigen::Vector3d& place,
                                              NoiseScratch& scratch) const {
        for (double radius = radius_; radius <= largest_; radius *= kGrowth) {
            auto look = look_through(place, radius, scratch);
            if (!look) return std::nullopt;
            if (kSigmasInBall * look->between > radius) continue;
            const auto wider = look_through(place, kWider * radius, scratch);
            if (!wider || wider->between > kMostMore * look->between) return std::nullopt;
            return look;
        }
        return std::nullopt;
    }

    [[nodiscard]] std::optional<Look> look_through(const Eigen::Vector3d& place, double radius,
                                                   NoiseScratch& scratch) const {
        Look look{read_noise(grid_, place, radius, scratch)};
        const bool is_body = look.reading.spread.is_curve && !of_curves_;
        if (look.reading.radius <= 0 || is_body) return std::nullopt;
        const double deviation = deviation_between_neighbours(scratch.ball, scratch.heights);
        look.between = look.reading.noise(deviation, kDeviationsBelow);
        return look;
    }

    const PointGrid& grid_;
    double radius_;
    double largest_;
    bool of_curves_;  // the shape is made of them
};

/// The noise of a place by the balls near it, without two sheets that they hold.
double noise_about(const Numbers& near, const std::vector<Look>& looks) {
    std::vector<Spread> spreads;
    for (const std::uint32_t i : near) spreads.push_back(looks[i].reading.spread);
    const HiddenSheets sheets = find_hidden_sheets(spreads);
    std::vector<double> noises;
    for (const std::uint32_t i : near) {
        const auto& [reading, between] = looks[i];
        noises.push_back(sheets.are_parted && reading.spread.is_parted
                             ? std::min(between, noise_by(reading, &Spread::deviation))
                             : between);
    }
    return std::sqrt(1 - sheets.share) * quantile(noises, kQuantile);
}

}  // namespace

std::optional<NoiseVariation> find_noise_variation(const Readings& readings,
                                                   const SampledCloud& cloud, const PointGrid& grid,
                                                   const NoiseSearch& search,
                                                   const Execution& execution) {
    if (!seems_to_vary(readings, search.least)) return std::nullopt;
    const std::vector<Eigen::Index> points = cloud.some(kBalls);
    const std::vector<Look> looks =
        Looking(readings, grid, search.largest_ball).run(cloud, points, execution);
    if (static_cast<double>(looks.size()) < kLeastSeen * static_cast<double>(points.size())) {
        return std::nullopt;
    }
    Points places = places_of(looks, [](const Look& look) { return look.reading.place; });
    std::vector<double> noises;
    for (const Numbers& near : neighbourhoods(places)) {
        noises.push_back(std::max(search.lowest, noise_about(near, looks)));
    }
    if (!vary(noises, search.least)) return std::nullopt;
    const double usual =
        std::accumulate(noises.begin(), noises.end(), 0.0) / static_cast<double>(noises.size());
    for (double& noise : noises) noise = std::clamp(noise / usual, kLeastFactor, kMostFactor);
    return NoiseVariation{usual, NoiseMap(places, std::move(noises))};
}

}  // namespace lpf
