#include "core/field/seed_sizes.h"

#include <algorithm>

namespace lpf {
namespace {

/// Sizes that are tried, in radii, from large to small; none smaller than so many sigma, except
/// for the last that is left.
constexpr double kSizes[] = {2.8, 2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25};
constexpr double kLeastSigmasOfSize = 2.4;

/// Where there is less noise [radius], LPFs larger than asked for only lose detail.
constexpr double kLeastNoiseToAverage = 0.03;

bool is_worth_averaging(const SeedingParams& params, double noise) {
    return noise >= kLeastNoiseToAverage * params.radius;
}

}  // namespace

std::vector<double> radii_to_try(const SeedingParams& params) {
    if (!params.adapt_radius) return {params.radius};
    const double most = params.noise_map.most() * params.noise;
    const double least = params.noise_map.least() * params.noise;
    std::vector<double> radii;
    for (const double size : kSizes) {
        const double radius = size * params.radius;
        if (size > 1 && !is_worth_averaging(params, most)) continue;
        if (radius >= std::max(params.least_radius, least_radius(least))) radii.push_back(radius);
    }
    if (radii.empty()) radii.push_back(params.radius);
    return radii;
}

double largest_radius(const SeedingParams& params) { return radii_to_try(params).front(); }

double least_radius(double noise) { return kLeastSigmasOfSize * noise; }

bool suits_noise(const SeedingParams& params, double radius, double noise) {
    if (params.noise_map.is_even() || !params.adapt_radius) return true;
    if (radius < least_radius(noise)) return false;
    return radius <= params.radius || is_worth_averaging(params, noise);
}

bool is_last_for_noise(const SeedingParams& params, double next, double noise) {
    return !params.noise_map.is_even() && next < least_radius(noise);
}

}  // namespace lpf
