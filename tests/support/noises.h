#pragma once

#include <vector>

#include "tests/support/shapes.h"

namespace lpf::test {

// Noise that is not as usual: normal, in all directions, the same everywhere.

/// Even in every coordinate, with a standard deviation of sigma.
Points with_even_noise(const Points& exact, double sigma);

/// Long-tailed (Laplace) in every coordinate, with a standard deviation of sigma.
Points with_long_tails(const Points& exact, double sigma);

/// Normal, along z alone, as of a camera that looks down.
Points with_noise_along_z(const Points& exact, double sigma);

/// The points with coordinates that are multiples of a step, each place once.
Points rounded(const Points& exact, double step);

/// A scan whose noise rises eightfold along x.
struct UnevenScan {
    Points points;
    std::vector<double> noise;  ///< standard deviation of each point
};

/// @param least noise, where x is least
UnevenScan with_uneven_noise(const Points& exact, double least);

}  // namespace lpf::test
