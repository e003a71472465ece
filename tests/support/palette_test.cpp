#include "tests/support/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace lpf::test {
namespace {

TEST(Palette, FewColoursAreKeptExactly) {
    Image image(20, 10, Colour(1, 1, 1));
    image.at(3, 4) = Colour(1, 0, 0);
    image.at(5, 6) = Colour(0, 0, 1);
    const IndexedPicture picture = with_few_colours(image, 16);
    ASSERT_EQ(picture.palette.size(), 3U);
    ASSERT_EQ(picture.indices.size(), 200U);
    const auto at = [&](std::size_t x, std::size_t y) {
        return picture.palette[picture.indices[20 * y + x]];
    };
    EXPECT_EQ(at(3, 4), (std::array<std::uint8_t, 3>{255, 0, 0}));
    EXPECT_EQ(at(5, 6), (std::array<std::uint8_t, 3>{0, 0, 255}));
    EXPECT_EQ(at(0, 0), (std::array<std::uint8_t, 3>{255, 255, 255}));
}

TEST(Palette, AGradientIsFollowedWithinItsSteps) {
    Image image(256, 4, Colour(0, 0, 0));
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 256; ++x) image.at(x, y) = Colour::Constant(float(x) / 255.0F);
    }
    const IndexedPicture picture = with_few_colours(image, 32);
    EXPECT_EQ(picture.palette.size(), 32U);
    for (int x = 0; x < 256; ++x) {
        const int shown = picture.palette[picture.indices[static_cast<std::size_t>(x)]][0];
        EXPECT_LE(std::abs(shown - x), 8) << x;
    }
}

TEST(Palette, APictureInFewColoursIsASmallerFile) {
    Image image(200, 100, Colour(0, 0, 0));
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 200; ++x) {
            image.at(x, y) = Colour(float((x * 7919 + y * 104729) % 997) / 997.0F, 0.5F, 0.5F);
        }
    }
    const std::string path = testing::TempDir() + "lpf_palette_test.png";
    const auto size_of = [&](int colours) {
        colours > 0 ? image.save_png(path, colours) : image.save_png(path);
        std::ifstream file(path, std::ios::binary | std::ios::ate);
        return static_cast<long>(file.tellg());
    };
    EXPECT_LT(size_of(16), size_of(0) / 2);
    std::remove(path.c_str());
}

}  // namespace
}  // namespace lpf::test
