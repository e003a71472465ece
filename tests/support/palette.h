#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tests/support/image.h"

namespace lpf::test {

/// A picture in few colours: its file is a fraction of the size.
struct IndexedPicture {
    std::vector<std::array<std::uint8_t, 3>> palette;
    std::vector<std::uint8_t> indices;  ///< one for each pixel, row by row
};

/// Median cut (Heckbert, SIGGRAPH 1982): the box of colours that is widest for its pixels is split
/// at the median of its widest channel until there are `colours` boxes. Deterministic.
/// @pre 1 <= colours <= 256
[[nodiscard]] IndexedPicture with_few_colours(const Image& image, int colours);

}  // namespace lpf::test
