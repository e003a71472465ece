#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "api/codec/document.h"
#include "api/codec/format.h"

namespace lpf {

/// Reads a PLY file of any of its three kinds.
///
/// Header: at most 64 KiB, 16 elements, 256 properties an element; lines end in LF, CR LF or CR.
/// Counts are claims: they are compared with the bytes there are before memory is taken for them.
/// ASCII rows are lines; blank lines between them are allowed. Bytes after the last element are
/// ignored. Polygons become fans of triangles and stay available as polygons.
/// @throws Error{MalformedFile, LimitExceeded, Cancelled}
[[nodiscard]] Document decode_ply(std::span<const std::byte> bytes, const DecodeLimits& limits,
                                  const Execution& execution = {});

/// Writes everything the document holds. @pre options.format is a PLY format
/// @param lost  receives `attribute-renamed` for names that a PLY header cannot hold
[[nodiscard]] std::string encode_ply(const Document& document, const EncodeOptions& options,
                                     std::vector<Warning>& lost, const Execution& execution = {});

}  // namespace lpf
