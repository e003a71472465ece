#include "tests/support/chart.h"

#include <gtest/gtest.h>

namespace lpf::test {
namespace {

const Colour kRed(1, 0, 0);

int count_near(const Image& image, const Colour& colour, int from_x, int to_x) {
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = from_x; x < to_x; ++x) count += (image.at(x, y) - colour).norm() < 0.2F;
    }
    return count;
}

TEST(Chart, StepsAreRound) {
    EXPECT_DOUBLE_EQ(round_step(10, 5), 2);
    EXPECT_DOUBLE_EQ(round_step(0.7, 5), 0.2);
    EXPECT_DOUBLE_EQ(round_step(4100, 5), 1000);
    EXPECT_DOUBLE_EQ(round_step(0, 5), 1);
}

TEST(Chart, ALineIsDrawnFromItsFirstToItsLastPoint) {
    const Series falling{"", {0, 1}, {1, 0}, kRed};
    const Image image = line_chart({falling}, {}, {300, 200});
    EXPECT_GT(count_near(image, kRed, 0, 150), 80);
    EXPECT_GT(count_near(image, kRed, 150, 300), 80);
    // High on the left, low on the right.
    int left_row = 0, right_row = 0;
    for (int y = 0; y < 200; ++y) {
        if (image.at(70, y).x() > 0.9F && image.at(70, y).y() < 0.3F) left_row = y;
        if (image.at(270, y).x() > 0.9F && image.at(270, y).y() < 0.3F) right_row = y;
    }
    EXPECT_LT(left_row + 50, right_row);
}

TEST(Chart, BarsAreAsHighAsTheirShares) {
    const Colour bar(0.14F, 0.36F, 0.56F);
    const Image image = histogram({0.1, 0.1, 0.1, 0.9, 5.0}, 0, 1, 2, {}, {300, 200});
    const double left = count_near(image, bar, 64, 173);
    const double right = count_near(image, bar, 173, 282);
    EXPECT_GT(right, 500);
    EXPECT_NEAR(left / right, 3.0, 0.2);
}

TEST(Chart, NothingIsAnEmptyFrame) {
    EXPECT_EQ(line_chart({}, {}, {200, 150}).width(), 200);
    EXPECT_EQ(histogram({}, 0, 1, 10, {}, {200, 150}).height(), 150);
}

}  // namespace
}  // namespace lpf::test
