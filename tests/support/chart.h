#pragma once

#include <string>
#include <vector>

#include "tests/support/image.h"
#include "tests/support/render.h"

namespace lpf::test {

/// What stands at the axes of a chart, and above it.
struct ChartLabels {
    std::string title = {};
    std::string x = {};
    std::string y = {};
};

/// One line of a chart: points (x_i, y_i) joined in their order.
struct Series {
    std::string label;
    std::vector<double> x;
    std::vector<double> y;
    Colour colour;
};

/// Lines over common axes; the vertical axis begins at zero, all values are to be >= 0.
[[nodiscard]] Image line_chart(const std::vector<Series>& series, const ChartLabels& labels,
                               const PictureSize& size);

/// How often values fall into each of `bins` equal parts of [low, high]; the shares of all values
/// are drawn in per cent. Values beyond the range are left out of the picture.
[[nodiscard]] Image histogram(const std::vector<double>& values, double low, double high, int bins,
                              const ChartLabels& labels, const PictureSize& size);

/// A round step that divides `range` into about `wanted` parts: 1, 2 or 5 times a power of ten.
[[nodiscard]] double round_step(double range, int wanted);

}  // namespace lpf::test
