#pragma once

#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/box.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// The part of a cloud that noise may have bent, in an order in which neighbours in space mostly
/// follow each other.
struct BentPart {
    std::vector<std::uint32_t> points;  ///< that matter to it, as indices into the cloud
    std::vector<std::uint32_t> bent;  ///< places in `points` of those that belong to it, ascending
    double near = 0.0;                ///< points within the reach of noise of one, on average
};

/// Finds what is not flat: where the points within the reach of noise are neither a plane nor a
/// line, or where these end. Finds nothing where too few points are near each other to tell.
/// @param noise  standard deviation off the shape that the points had before they were denoised
///               [input length], > 0
/// @param region what is to be searched
/// @param margin around it [input length]
[[nodiscard]] BentPart find_bent_part(const Points& shape, double noise, const Region& region,
                                      double margin, const Execution& execution);

/// One point in so many.
[[nodiscard]] Points one_in(std::size_t stride, const Points& points);

/// One in so many of `count` points are `most`, or up to twice as many.
[[nodiscard]] std::size_t stride_to(double most, double count);

}  // namespace lpf
