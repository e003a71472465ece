#include "api/codec/draco_claim.h"

#include <cstring>
#include <string_view>

#include "api/codec/text.h"

namespace lpf {
namespace {

constexpr std::uint16_t kHasMetadata = 0x8000;
constexpr std::uint8_t kEdgebreaker = 1;
constexpr std::uint64_t kMostPerByte = 1024;

/// Takes little-endian values from the front of a stream and names the place where it ends.
class ClaimReader {
public:
    explicit ClaimReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <typename T>
    T take(std::string_view what) {
        T value;
        std::memcpy(&value, skip(sizeof value, what).data(), sizeof value);
        return value;
    }

    std::uint64_t take_varint(std::string_view what) {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const auto byte = take<std::uint8_t>(what);
            value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
            if ((byte & 0x80) == 0) return value;
        }
        malformed("Draco stream, byte ", at_, ": ", what, " is longer than 64 bits");
    }

    std::span<const std::byte> skip(std::uint64_t size, std::string_view what) {
        if (bytes_.size() - at_ < size) {
            malformed("Draco stream ends at byte ", bytes_.size(), ", but ", what, " needs ", size,
                      " bytes at byte ", at_);
        }
        at_ += size;
        return bytes_.subspan(at_ - size, size);
    }

private:
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

/// One node of metadata: its entries. Returns how many nodes hang below it.
std::uint64_t skip_metadata_entries(ClaimReader& reader) {
    const std::uint64_t entries = reader.take_varint("the number of metadata entries");
    for (std::uint64_t i = 0; i < entries; ++i) {
        reader.skip(reader.take<std::uint8_t>("a metadata name"), "a metadata name");
        reader.skip(reader.take_varint("the size of a metadata value"), "a metadata value");
    }
    return reader.take_varint("the number of metadata children");
}

/// Nodes follow each other depth first, so a counter is all the stack that is needed.
void skip_metadata_tree(ClaimReader& reader) {
    std::uint64_t nodes = skip_metadata_entries(reader);
    while (nodes > 0) {
        --nodes;
        reader.skip(reader.take<std::uint8_t>("a metadata name"), "a metadata name");
        const std::uint64_t children = skip_metadata_entries(reader);
        if (children > UINT32_MAX || nodes > UINT32_MAX) malformed("Draco metadata is too large");
        nodes += children;
    }
}

void skip_geometry_metadata(ClaimReader& reader) {
    const std::uint64_t attributes = reader.take_varint("the number of attribute metadata");
    for (std::uint64_t i = 0; i < attributes; ++i) {
        (void)reader.take_varint("the attribute of a metadata");
        skip_metadata_tree(reader);
    }
    skip_metadata_tree(reader);
}

void read_mesh_counts(ClaimReader& reader, bool edgebreaker, DracoClaim& claim) {
    const unsigned version = claim.major * 256 + claim.minor;
    // Counts became varints with 2.0 in edgebreaker meshes and with 2.2 in sequential ones.
    const bool varint = version >= (edgebreaker ? 0x200U : 0x202U);
    const auto count = [&](std::string_view what) {
        return varint ? reader.take_varint(what) : reader.take<std::uint32_t>(what);
    };
    if (!edgebreaker) {
        claim.faces = count("the number of faces");
        claim.points = count("the number of points");
        return;
    }
    (void)reader.take<std::uint8_t>("the traversal method");
    if (version < 0x202U) (void)count("the number of new vertices");
    claim.points = count("the number of vertices");
    claim.faces = count("the number of faces");
}

void check_version(const DracoClaim& claim) {
    const unsigned newest_minor = claim.is_mesh ? 2 : 3;
    const bool known = claim.major == 1 || (claim.major == 2 && claim.minor <= newest_minor);
    if (!known) {
        fail(ErrorCode::UnsupportedFormat, "Draco bitstream version ", claim.major, ".",
             claim.minor, " of a ", claim.is_mesh ? "mesh" : "point cloud",
             " is not known; versions 1.0 to 2.", newest_minor,
             " are. Encode the shape again with another Draco release");
    }
}

void check_count(std::uint64_t count, std::string_view what, std::uint64_t file_bytes,
                 std::uint64_t limit) {
    if (count > file_bytes * kMostPerByte) {
        malformed("the Draco stream claims ", count, " ", what, ", which its ", file_bytes,
                  " bytes cannot hold");
    }
    if (count > limit) {
        fail(ErrorCode::LimitExceeded, "the Draco stream has ", count, " ", what, "; the limit is ",
             limit);
    }
}

}  // namespace

DracoClaim read_draco_claim(std::span<const std::byte> bytes) {
    ClaimReader reader(bytes);
    reader.skip(std::string_view("DRACO").size(), "the magic word");
    DracoClaim claim;
    claim.major = reader.take<std::uint8_t>("the version");
    claim.minor = reader.take<std::uint8_t>("the version");
    const auto geometry = reader.take<std::uint8_t>("the geometry type");
    const auto method = reader.take<std::uint8_t>("the encoding method");
    const auto flags = reader.take<std::uint16_t>("the flags");
    if (geometry > 1) {
        malformed("Draco stream, byte 7: geometry type ", unsigned{geometry},
                  " is not known; 0 is a point cloud and 1 a mesh");
    }
    if (method > 1) {
        malformed("Draco stream, byte 8: encoding method ", unsigned{method},
                  " is not known; 0 and 1 are");
    }
    claim.is_mesh = geometry == 1;
    check_version(claim);
    const bool can_have_metadata = claim.major > 1 || claim.minor >= 3;
    if (can_have_metadata && (flags & kHasMetadata) != 0) skip_geometry_metadata(reader);
    if (claim.is_mesh) {
        read_mesh_counts(reader, method == kEdgebreaker, claim);
    } else {
        claim.points = reader.take<std::uint32_t>("the number of points");
    }
    return claim;
}

void check_draco_claim(const DracoClaim& claim, std::uint64_t file_bytes,
                       const DecodeLimits& limits) {
    check_count(claim.points, "points", file_bytes, limits.max_points);
    check_count(claim.faces, "faces", file_bytes, limits.max_faces);
}

}  // namespace lpf
