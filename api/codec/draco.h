#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "api/codec/document.h"
#include "api/codec/format.h"

namespace lpf {

/// Reads a Draco stream: in the helper process if the limits name one, else in this process.
///
/// Attributes become columns: POSITION x y z; NORMAL nx ny nz; COLOR red green blue alpha;
/// TEX_COORD s t; GENERIC its metadata entry "name" (name_0, name_1, ... if it has several
/// components), or generic_<unique id>. Geometry metadata "comment" and "obj_info" become lines.
/// @throws Error{MalformedFile, UnsupportedFormat, LimitExceeded, Cancelled}
[[nodiscard]] Document decode_draco(std::span<const std::byte> bytes, const DecodeLimits& limits,
                                    const Execution& execution = {});

/// Decodes in this process and keeps non-finite points: the work of the helper.
/// @pre the claims of the stream were checked, or this process is limited
[[nodiscard]] Document decode_draco_unprotected(std::span<const std::byte> bytes,
                                                const DecodeLimits& limits);

/// Writes with Draco's sequential encoding, which keeps the order of points and faces; large
/// documents in the helper process, if the options name one.
/// @param lost  receives what Draco cannot hold: `faces-triangulated`, `faces-dropped`,
/// `face-attributes-dropped`,
///              `element-dropped`, `attribute-dropped`, `attribute-type-changed`,
///              `positions-rounded`
[[nodiscard]] std::string encode_draco(const Document& document, const EncodeOptions& options,
                                       std::vector<Warning>& lost, const Execution& execution = {});

/// Encodes in this process, whatever the size: the work of the helper.
[[nodiscard]] std::string encode_draco_here(const Document& document, const EncodeOptions& options,
                                            std::vector<Warning>& lost);

}  // namespace lpf
