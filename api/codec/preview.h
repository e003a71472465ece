#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/codec/document.h"
#include "api/codec/ply_header.h"

namespace lpf {

/// A fair share of the points of a file: about the same share of every part of it, in its order.
struct PointSample {
    Points points;                                     ///< 3 x K [input length]
    std::vector<std::array<std::uint8_t, 3>> colours;  ///< K of them, or none
    std::uint64_t total = 0;                           ///< points of the file
};

/// Picks rows of a binary PLY where they lie, so that ten million points are no more work than as
/// many as are wanted. Nothing if the file is of another kind, or its rows differ in length.
/// @throws Error{MalformedFile} for a header that cannot be read
[[nodiscard]] std::optional<PointSample> sample_rows(std::span<const std::byte> file,
                                                     std::size_t most);

/// The same from a decoded file.
[[nodiscard]] PointSample sample_document(const Document& document, std::size_t most);

/// What is told about a preview besides its points.
struct PreviewHead {
    std::uint64_t points = 0;
    std::uint64_t total = 0;  ///< points of the file that it shows
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// A binary PLY of float32 positions, and colours if there are any. Positions are relative to an
/// offset that its comments tell; zero where float32 holds the coordinates well enough.
[[nodiscard]] std::string encode_preview(const PointSample& sample);

/// @pre file was made by encode_preview
[[nodiscard]] PreviewHead read_preview_head(std::span<const std::byte> file);

}  // namespace lpf
