#pragma once

#include <vector>

#include "core/shape/point_grid.h"

namespace lpf {

/// How the points of a ball scatter about the plane that suits them best, or about two parallel
/// ones where the ball holds both sides of something thin. Lengths in radii of the ball.
struct Spread {
    double deviation = 0.0;  ///< standard deviation off the plane, or off the nearer one
    double kurtosis = 3.0;   ///< of the distances off one plane, without what few points do to it
    double points = 0.0;     ///< that were used
    bool is_parted = false;  ///< there are two planes
};

/// @param ball at least 4 points
/// @param heights a buffer that is used again and again
[[nodiscard]] Spread spread_in(const NearPoints& ball, std::vector<double>& heights);

/// The deviation of what scatters like noise, without what the ball has cut off.
[[nodiscard]] double uncut_deviation(const Spread& spread);

}  // namespace lpf
