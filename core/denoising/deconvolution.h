#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/box.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// What happens further off is of no use to points that are deconvolved [standard deviations of the
/// noise].
inline constexpr double kReachOfDeconvolution = 24.0;

/// Takes from a denoised cloud what noise has added to its shape. Noise does not only scatter
/// points: it rounds edges, and runs near sheets together, in the target area of every LPF alike.
///
/// Steps of expectation maximisation make the cloud explain its scan: each point of the scan is
/// shared out among those of the shape by how likely noise led from each to it, and each of these
/// goes to the mean of what it got, as far as that is no chance (deconvolution after Richardson,
/// 1972, and Lucy, 1974; Dempster, Laird and Rubin, 1977). Then points that are left in the thin,
/// beside an edge or between two sheets, follow those around them. Departs from the paper, which
/// ends with the votes. Flat parts stay as they are.
/// @param scan   the noisy points, 3 x N, finite
/// @param noise  their standard deviation off the shape [input length], > 0
/// @param region where points are wanted; those further off stay
/// @param shape  in and out: the same points denoised, 3 x N
/// @returns indices of the points that do not lie on flat parts, in no order
std::vector<std::uint32_t> deconvolve(const Points& scan, double noise, const Region& region,
                                      Points& shape, const Execution& execution);

}  // namespace lpf
