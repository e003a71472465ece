#include "core/shape/extent.h"

#include <string>

#include "core/base/error.h"

namespace lpf {
namespace {

constexpr std::size_t kFewestPoints = 3;

}  // namespace

void check_number_of_points(std::size_t points) {
    if (points >= kFewestPoints) return;
    throw Error(ErrorCode::TooFewPoints,
                "The shape has " + std::to_string(points) + " points; at least 3 are needed.");
}

void check_extent(double extent) {
    if (extent > 0) return;
    throw Error(ErrorCode::DegenerateShape, "All points of the shape coincide: it has no extent.");
}

}  // namespace lpf
