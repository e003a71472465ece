#pragma once

#include <cstdint>
#include <vector>

#include "api/codec/document.h"
#include "api/job_inputs.h"
#include "core/auto_parameters.h"
#include "core/shape/tiling.h"

namespace lpf::server {

/// The part of a shape that is looked at before a job: all of it, or, of a large one, a few boxes
/// that hold as many points as can be looked at in a second or two.
struct ShapePart {
    Shape shape;
    double share = 1;  ///< of the points of the whole

    [[nodiscard]] bool is_whole() const { return share >= 1; }
};

/// @param most points that are looked at, about
[[nodiscard]] ShapePart part_of_shape(const Shape& shape, std::size_t most);

/// The same of a shape that is not held.
[[nodiscard]] ShapePart part_of_points(const PointSource& source, const Sketch& sketch,
                                       std::size_t most, const Execution& execution);

/// As `measure` of the whole shape, from a part of it. @param points, diagonal of the whole
[[nodiscard]] Measurements measure_part(const ShapePart& part, std::size_t points, double diagonal,
                                        const Execution& execution);

/// What is found on a part, and told of the whole.
struct Findings {
    double duplicates = 0;
    double outliers = 0;
    std::vector<std::uint32_t> neighbours;  ///< within the radius, of a sample; ascending
    double fields = 0;
    double points_per_field = 0;
    double probed_points = 0;
};

[[nodiscard]] Findings examine(const ShapePart& part, const ResolvedParameters& parameters,
                               const Execution& execution);

}  // namespace lpf::server
