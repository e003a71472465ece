#pragma once

#include <cstddef>
#include <span>

#include "api/codec/document.h"
#include "api/codec/draco_claim.h"
#include "api/codec/format.h"
#include "api/codec/helper_process.h"

namespace lpf {

/// Decodes in the helper program, which limits its own memory and time, so that a stream on which
/// the decoder crashes, hangs or swallows memory costs one error and nothing else. The document
/// comes back as a binary PLY, which is read like any other upload.
/// @throws Error{MalformedFile, LimitExceeded, Cancelled}; Error{Internal} if the helper cannot be
/// started
[[nodiscard]] Document decode_draco_in_child(std::span<const std::byte> bytes,
                                             const DracoClaim& claim, const DecodeLimits& limits,
                                             const Execution& execution = {});

/// The same up to the PLY, which is left in `streams.out`.
void decode_draco_to_ply(std::span<const std::byte> bytes, const DracoClaim& claim,
                         const DecodeLimits& limits, HelperStreams& streams,
                         const Execution& execution);

/// Encodes in the helper program, because Draco's encoder cannot be told to stop, but a process can
/// be killed. The result is that of encoding here.
/// @throws Error{Cancelled, OutOfMemory, Internal}
[[nodiscard]] std::string encode_draco_in_child(const Document& document,
                                                const EncodeOptions& options,
                                                std::vector<Warning>& lost,
                                                const Execution& execution);

/// Exit status of the helper after it wrote an error, its code in the first line, to descriptor 2.
inline constexpr int kDecodeHelperRefused = 3;

}  // namespace lpf
