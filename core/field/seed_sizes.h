#pragma once

#include <vector>

#include "core/field/seeding.h"

namespace lpf {

/// The radii that LPFs are tried with, from large to small; at least one [input length].
[[nodiscard]] std::vector<double> radii_to_try(const SeedingParams& params);

/// The radius of the largest LPFs that the parameters may lead to [input length].
[[nodiscard]] double largest_radius(const SeedingParams& params);

/// LPFs that adapt are no smaller in so much noise, but for the last that is left [input length].
[[nodiscard]] double least_radius(double noise);

/// Where noise varies, whether a radius is for a place with so much of it: neither averages too
/// little nor loses detail for nothing. Where it is even, all that are tried are.
[[nodiscard]] bool suits_noise(const SeedingParams& params, double radius, double noise);

/// Where noise varies, whether the next radius that is tried is too small for a place with so much
/// of it: what is left there has its last chance now.
[[nodiscard]] bool is_last_for_noise(const SeedingParams& params, double next, double noise);

}  // namespace lpf
