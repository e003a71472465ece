#include "tests/support/chart.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace lpf::test {
namespace {

const Colour kPaper(1.0F, 1.0F, 1.0F);
const Colour kInk(0.15F, 0.17F, 0.20F);
const Colour kGrid(0.88F, 0.89F, 0.91F);
const Colour kBar(0.14F, 0.36F, 0.56F);
constexpr double kLetters = 11;

std::string text(double value) {
    std::ostringstream out;
    out.precision(3);
    out << (std::abs(value) < 1e-12 ? 0.0 : value);
    return out.str();
}

/// An empty chart: axes, grid, labels, and where a pair of values lies on it.
class Chart {
public:
    Chart(double x_low, double x_high, double y_high, const ChartLabels& labels,
          const PictureSize& size)
        : image_(size.width, size.height, kPaper),
          x_low_(x_low),
          x_high_(x_high > x_low ? x_high : x_low + 1),
          y_high_(y_high > 0 ? y_high : 1) {
        draw_grid();
        image_.line(at(x_low_, 0), at(x_high_, 0), 1.5, kInk);
        image_.line(at(x_low_, 0), at(x_low_, y_high_), 1.5, kInk);
        image_.write(labels.title, kLeft, 6, 13, kInk);
        image_.write(labels.y, 8, kTop - 16, kLetters, kInk);
        image_.write(labels.x, size.width / 2 - 40, size.height - 18, kLetters, kInk);
    }

    [[nodiscard]] Eigen::Vector2d at(double x, double y) const {
        const double width = image_.width() - kLeft - kRight;
        const double height = image_.height() - kTop - kBottom;
        return {kLeft + width * (x - x_low_) / (x_high_ - x_low_),
                kTop + height * (1 - y / y_high_)};
    }
    [[nodiscard]] Image& image() { return image_; }

    /// Fills the area over [left, right] up to a height, a pixel of air at its sides.
    void bar(double left, double right, double height) {
        const Eigen::Vector2d corner = at(left, height), opposite = at(right, 0);
        for (int y = int(std::lround(corner.y())); y < int(opposite.y()); ++y) {
            for (int x = int(corner.x()) + 1; x < int(opposite.x()); ++x) image_.at(x, y) = kBar;
        }
    }

private:
    static constexpr int kLeft = 64, kRight = 18, kTop = 44, kBottom = 44;

    void draw_grid() {
        const double y_step = round_step(y_high_, 5);
        for (double y = 0; y <= y_high_ * 1.001; y += y_step) {
            image_.line(at(x_low_, y), at(x_high_, y), 1, kGrid);
            image_.write(text(y), 8, static_cast<int>(at(0, y).y()) - 5, kLetters, kInk);
        }
        const double x_step = round_step(x_high_ - x_low_, 5);
        for (double x = std::ceil(x_low_ / x_step) * x_step; x <= x_high_ * 1.001; x += x_step) {
            image_.line(at(x, 0), at(x, 0) + Eigen::Vector2d(0, 5), 1, kInk);
            image_.write(text(x), static_cast<int>(at(x, 0).x()) - 10,
                         image_.height() - kBottom + 9, kLetters, kInk);
        }
    }

    Image image_;
    double x_low_, x_high_, y_high_;
};

}  // namespace

double round_step(double range, int wanted) {
    const double rough = range / std::max(1, wanted);
    if (!(rough > 0)) return 1.0;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * power >= rough * 0.999) return factor * power;
    }
    return 10 * power;
}

Image line_chart(const std::vector<Series>& series, const ChartLabels& labels,
                 const PictureSize& size) {
    std::vector<double> all_x, all_y{0.0};
    for (const Series& each : series) {
        all_x.insert(all_x.end(), each.x.begin(), each.x.end());
        all_y.insert(all_y.end(), each.y.begin(), each.y.end());
    }
    if (all_x.empty()) all_x.push_back(0.0);
    const auto [x_low, x_high] = std::minmax_element(all_x.begin(), all_x.end());
    Chart chart(*x_low, *x_high, 1.05 * *std::max_element(all_y.begin(), all_y.end()), labels,
                size);
    int row = 0;
    for (const Series& each : series) {
        for (std::size_t i = 0; i + 1 < std::min(each.x.size(), each.y.size()); ++i) {
            chart.image().line(chart.at(each.x[i], each.y[i]),
                               chart.at(each.x[i + 1], each.y[i + 1]), 2, each.colour);
        }
        const int y = 52 + 18 * row++;
        chart.image().line({size.width - 130.0, y + 5.0}, {size.width - 106.0, y + 5.0}, 3,
                           each.colour);
        chart.image().write(each.label, size.width - 98, y, kLetters, kInk);
    }
    return std::move(chart.image());
}

Image histogram(const std::vector<double>& values, double low, double high, int bins,
                const ChartLabels& labels, const PictureSize& size) {
    std::vector<double> shares(static_cast<std::size_t>(std::max(1, bins)), 0.0);
    const double width = (high - low) / static_cast<double>(shares.size());
    for (const double value : values) {
        const double bin = std::floor((value - low) / width);
        if (bin < 0 || bin >= static_cast<double>(shares.size())) continue;
        shares[static_cast<std::size_t>(bin)] += 100.0 / static_cast<double>(values.size());
    }
    Chart chart(low, high, 1.05 * *std::max_element(shares.begin(), shares.end()), labels, size);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double x = low + width * static_cast<double>(i);
        if (shares[i] > 0) chart.bar(x, x + width, shares[i]);
    }
    return std::move(chart.image());
}

}  // namespace lpf::test
