#pragma once

#include <vector>

#include "core/shape/point_grid.h"

namespace lpf {

/// How the points of a ball scatter about the quadric that suits them best, or about two where the
/// ball holds both sides of something thin. Lengths in radii of the ball.
struct Spread {
    /// What lies within so many deviations of the quadric is in the middle.
    static constexpr double kMiddle = 0.25;

    double deviation = 0.0;  ///< standard deviation off the quadric, or off the nearer one
    double whole = 0.0;      ///< standard deviation off the one quadric
    double kurtosis = 3.0;   ///< of the distances off one, without what few points do to it
    double in_middle = 0.0;  ///< share of the points within kMiddle `whole` of the one quadric
    double freedom = 0.0;    ///< points that were used, without those that the quadric took up
    bool is_parted = false;  ///< there are two
    bool is_curve = false;   ///< they lie along a line
};

/// @param ball at least 4 points
/// @param heights a buffer that is used again and again
[[nodiscard]] Spread spread_in(const NearPoints& ball, std::vector<double>& heights);

/// The standard deviation off one quadric as it shows in how far the heights of neighbours on it
/// differ: detail that the quadric misses, they have in common. @param ball as above
[[nodiscard]] double deviation_between_neighbours(const NearPoints& ball,
                                                  std::vector<double>& heights);

/// The deviation of noise of which a ball has cut off so much that this one is left. Both are in
/// radii of the ball.
[[nodiscard]] double uncut(double deviation);

}  // namespace lpf
