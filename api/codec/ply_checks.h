#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "api/codec/format.h"
#include "api/codec/ply_columns.h"
#include "api/codec/ply_header.h"

namespace lpf {

/// Compares what the header promises with the bytes there are, before memory is taken for it.
/// @throws Error{MalformedFile, LimitExceeded}
void check_ply_claims(const PlyHeader& header, std::size_t file_bytes, const DecodeLimits& limits);

/// The element that holds the points. @throws Error{MalformedFile} if there is none with x, y, z
[[nodiscard]] const PlyElement& ply_vertices(const PlyHeader& header);

/// The property that makes faces of the element `face`.
[[nodiscard]] bool is_face_list(const PlyProperty& property);

/// All vertex numbers of a column of faces in a row; a negative one becomes one out of every range.
/// @throws Error{MalformedFile} if they are no whole numbers
[[nodiscard]] std::vector<std::uint32_t> vertex_numbers(const PlyColumn& column);

/// @param polygons  without offsets if all are triangles
/// @param first_face  number of the first of them in the file
/// @throws Error{MalformedFile} for a number that is no vertex
void check_vertex_numbers(const Polygons& polygons, std::size_t first_face, std::size_t points);

}  // namespace lpf
