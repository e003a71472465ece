#include "tests/support/palette.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lpf::test {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

struct Counted {
    Rgb colour;
    std::size_t pixels;
};

/// A part of the colours: [begin, end) of the list, and how wide it is.
struct Box {
    std::size_t begin;
    std::size_t end;
    std::size_t channel = 0;  // the widest
    double urgency = 0.0;     // width times the root of the pixels: what splitting it is worth
};

Rgb rounded(const Colour& pixel) {
    Rgb rgb;
    for (std::size_t c = 0; c < 3; ++c) {
        const float value = std::clamp(pixel[static_cast<Eigen::Index>(c)], 0.0F, 1.0F);
        rgb[c] = static_cast<std::uint8_t>(std::lround(255.0F * value));
    }
    return rgb;
}

Box measured(const std::vector<Counted>& list, std::size_t begin, std::size_t end) {
    Box box{begin, end};
    std::size_t pixels = 0;
    for (std::size_t i = begin; i < end; ++i) pixels += list[i].pixels;
    int widest = -1;
    for (std::size_t c = 0; c < 3; ++c) {
        std::uint8_t low = 255, high = 0;
        for (std::size_t i = begin; i < end; ++i) {
            low = std::min(low, list[i].colour[c]);
            high = std::max(high, list[i].colour[c]);
        }
        if (high - low <= widest) continue;
        widest = high - low;
        box.channel = c;
    }
    box.urgency = widest * std::sqrt(static_cast<double>(pixels));
    return box;
}

/// The first of the upper half of the pixels; both halves hold a colour. @pre two colours or more
std::size_t split_at_median(std::vector<Counted>& list, const Box& box) {
    const auto at = [&](std::size_t i) { return list.begin() + static_cast<long>(i); };
    std::sort(at(box.begin), at(box.end), [&](const Counted& a, const Counted& b) {
        return std::pair(a.colour[box.channel], a.colour) <
               std::pair(b.colour[box.channel], b.colour);
    });
    std::size_t total = 0, seen = 0;
    for (std::size_t i = box.begin; i < box.end; ++i) total += list[i].pixels;
    for (std::size_t i = box.begin; i + 1 < box.end; ++i) {
        seen += list[i].pixels;
        if (2 * seen >= total) return i + 1;
    }
    return box.end - 1;
}

Rgb mean_colour(const std::vector<Counted>& list, const Box& box) {
    double sums[3] = {0, 0, 0}, pixels = 0;
    for (std::size_t i = box.begin; i < box.end; ++i) {
        const auto count = static_cast<double>(list[i].pixels);
        for (std::size_t c = 0; c < 3; ++c) sums[c] += count * list[i].colour[c];
        pixels += count;
    }
    Rgb mean;
    for (std::size_t c = 0; c < 3; ++c) {
        mean[c] = static_cast<std::uint8_t>(std::lround(sums[c] / pixels));
    }
    return mean;
}

std::vector<Box> cut(std::vector<Counted>& list, std::size_t colours) {
    std::vector<Box> boxes{measured(list, 0, list.size())};
    while (boxes.size() < colours) {
        const auto next = std::ranges::max_element(boxes, {}, &Box::urgency);
        if (next->urgency <= 0) break;
        const Box box = *next;
        const std::size_t middle = split_at_median(list, box);
        *next = measured(list, box.begin, middle);
        boxes.push_back(measured(list, middle, box.end));
    }
    return boxes;
}

}  // namespace

IndexedPicture with_few_colours(const Image& image, int colours) {
    std::map<Rgb, std::size_t> counts;
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) ++counts[rounded(image.at(x, y))];
    }
    std::vector<Counted> list;
    for (const auto& [colour, pixels] : counts) list.push_back({colour, pixels});

    IndexedPicture picture;
    std::map<Rgb, std::uint8_t> index;
    for (const Box& box : cut(list, static_cast<std::size_t>(colours))) {
        for (std::size_t i = box.begin; i < box.end; ++i) {
            index[list[i].colour] = static_cast<std::uint8_t>(picture.palette.size());
        }
        picture.palette.push_back(mean_colour(list, box));
    }
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x) {
            picture.indices.push_back(index.at(rounded(image.at(x, y))));
        }
    }
    return picture;
}

}  // namespace lpf::test
