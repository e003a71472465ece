#include "core/shape/noise_map.h"

#include <algorithm>
#include <cmath>

#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

/// Between the places where it is known, noise is the mean of so many, by their distance.
constexpr std::size_t kPlaces = 4;

}  // namespace

struct NoiseMap::Known {
    SpatialIndex index;
    std::vector<double> factors;
};

NoiseMap::NoiseMap(const Points& places, std::vector<double> factors)
    : known_(std::make_shared<const Known>(Known{SpatialIndex(places), std::move(factors)})) {}

double NoiseMap::factor_at(const Eigen::Vector3d& place) const {
    if (is_even()) return 1.0;
    const auto near = known_->index.nearest(place, kPlaces);
    // The farthest of them counts for nothing, so that the mean jumps nowhere.
    const double reach = std::sqrt(near.back().squared_distance);
    double sum = 0.0;
    double weights = 0.0;
    for (const auto& [index, squared_distance] : near) {
        const double weight = reach - std::sqrt(squared_distance);
        sum += weight * known_->factors[index];
        weights += weight;
    }
    return weights > 0 ? sum / weights : known_->factors[near.front().index];
}

double NoiseMap::most() const { return is_even() ? 1.0 : std::ranges::max(known_->factors); }

double NoiseMap::least() const { return is_even() ? 1.0 : std::ranges::min(known_->factors); }

}  // namespace lpf
