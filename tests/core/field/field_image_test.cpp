#include "core/field/field_image.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace lpf {
namespace {

/// Reads as the stencils of the pattern say, on a grid as on any other.
void expect_stencils(const Pattern& pattern) {
    Random random(4);
    std::vector<float> field(3 * static_cast<std::size_t>(pattern.padded_size()));
    for (float& value : field) value = static_cast<float>(random.normal());
    FieldImage image(pattern);
    image.assign(field.data());
    constexpr std::size_t kPlaces = 300;
    std::vector<float> x(kPlaces), y(kPlaces), out[3];
    for (std::size_t i = 0; i < kPlaces; ++i) {
        x[i] = static_cast<float>(random.uniform(-1.1, 1.1));
        y[i] = static_cast<float>(random.uniform(-1.1, 1.1));
    }
    for (auto& channel : out) channel.resize(kPlaces);
    float* const to[3] = {out[0].data(), out[1].data(), out[2].data()};
    image.read(x.data(), y.data(), kPlaces, to);
    for (std::size_t i = 0; i < kPlaces; ++i) {
        const Pattern::Stencil stencil = pattern.stencil(x[i], y[i]);
        for (int c = 0; c < 3; ++c) {
            double expected = 0;
            for (int k = 0; k < 4; ++k) {
                const int node = c * pattern.padded_size() + stencil.node[k];
                expected +=
                    double{stencil.weight[k]} * double{field[static_cast<std::size_t>(node)]};
            }
            ASSERT_NEAR(out[c][i], expected, 1e-4);
        }
    }
}

TEST(FieldImage, ReadsGridsAsTheirStencilsDo) {
    for (const int n : {4, 5, 16, 33}) expect_stencils(Pattern::grid(n));
}

TEST(FieldImage, ReadsOtherPatternsAsTheirStencilsDo) {
    expect_stencils(Pattern::random_disk(150, 3));
}

}  // namespace
}  // namespace lpf
