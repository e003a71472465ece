#pragma once

#include <cstdint>

#include "api/codec/document.h"
#include "core/base/parallel.h"

namespace lpf {

/// Each polygon as a fan of triangles around its first vertex; faces of fewer than 3 vertices give
/// none.
/// @throws Error{LimitExceeded} for more than `max_faces` triangles
[[nodiscard]] Triangles fans_of(const Polygons& polygons, std::uint64_t max_faces);

/// @throws Error{LimitExceeded} for more than `max_faces` triangles
void check_triangle_count(std::uint64_t count, std::uint64_t max_faces);

/// What is said of points that are not finite. @throws Error{MalformedFile} if none is
[[nodiscard]] Warning dropped_points_warning(std::uint64_t dropped, std::uint64_t all);

/// Leaves out every point with a NaN or infinite coordinate, every face that uses one, and every
/// element that refers to points by number; attributes stay aligned. Says so in the warnings.
/// @throws Error{MalformedFile} if there are points, but none is finite; Error{Cancelled}
void drop_non_finite_points(Document& document, const Execution& execution = {});

/// True for elements of known meaning that hold point numbers, such as `edge` and `tristrips`.
[[nodiscard]] bool refers_to_points(const Element& element);

}  // namespace lpf
