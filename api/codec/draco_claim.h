#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "api/codec/format.h"

namespace lpf {

/// What a Draco stream says of itself before anything is decoded.
struct DracoClaim {
    unsigned major = 0;  ///< bitstream version
    unsigned minor = 0;
    bool is_mesh = false;
    std::uint64_t points = 0;  ///< for an edgebreaker mesh, without the copies that seams need
    std::uint64_t faces = 0;

    /// Versions that today's encoders write; older ones reach code that trusts its input more.
    [[nodiscard]] bool is_current() const { return major == 2 && minor >= 2; }
};

/// Reads the header, walks over the metadata and reads the counts. Allocates nothing.
/// @throws Error{MalformedFile, UnsupportedFormat}
[[nodiscard]] DracoClaim read_draco_claim(std::span<const std::byte> bytes);

/// A stream of 62 bytes can claim 4 billion points, and decoding believes it: compare first.
/// @throws Error{MalformedFile} for more than 1024 points or faces per byte
/// @throws Error{LimitExceeded}
void check_draco_claim(const DracoClaim& claim, std::uint64_t file_bytes,
                       const DecodeLimits& limits);

}  // namespace lpf
