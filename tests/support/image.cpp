#include "tests/support/image.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "tests/support/palette.h"

namespace lpf::test {
namespace {

png_image png_of(const Image& image, png_uint_32 format) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width());
    png.height = static_cast<png_uint_32>(image.height());
    png.format = format;
    return png;
}

void write_png(const std::string& path, png_image png, const void* pixels, const void* palette) {
    if (!png_image_write_to_file(&png, path.c_str(), 0, pixels, 0, palette)) {
        throw Error(ErrorCode::StorageFailure,
                    "The picture " + path + " could not be written: " + png.message + ".");
    }
}

}  // namespace

Image::Image(int width, int height, const Colour& background)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

Image Image::halved() const {
    Image half(width_ / 2, height_ / 2, Colour::Zero());
    for (int y = 0; y < half.height_; ++y) {
        for (int x = 0; x < half.width_; ++x) {
            half.at(x, y) = 0.25F * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) +
                                     at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1));
        }
    }
    return half;
}

void Image::paste(const Image& other, int x, int y) {
    for (int row = 0; row < other.height_; ++row) {
        for (int column = 0; column < other.width_; ++column) {
            at(x + column, y + row) = other.at(column, row);
        }
    }
}

void Image::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
                 const Colour& colour) {
    const double half = width / 2;
    const Eigen::Vector2d low = from.cwiseMin(to).array() - half - 1;
    const Eigen::Vector2d high = from.cwiseMax(to).array() + half + 2;
    const Eigen::Vector2d edge = to - from;
    for (int y = std::max(0, int(low.y())); y < std::min(height_, int(high.y())); ++y) {
        for (int x = std::max(0, int(low.x())); x < std::min(width_, int(high.x())); ++x) {
            const Eigen::Vector2d d = Eigen::Vector2d(x + 0.5, y + 0.5) - from;
            const double length2 = edge.squaredNorm();
            const double t = length2 > 0 ? std::clamp(d.dot(edge) / length2, 0.0, 1.0) : 0.0;
            const double off = (d - t * edge).norm();
            const auto cover = static_cast<float>(std::clamp(half + 0.5 - off, 0.0, 1.0));
            at(x, y) += cover * (colour - at(x, y));
        }
    }
}

void Image::save_png(const std::string& path) const {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(pixels_.size() * 3);
    for (const Colour& pixel : pixels_) {
        for (int c = 0; c < 3; ++c) {
            bytes.push_back(
                static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(pixel[c], 0.0F, 1.0F))));
        }
    }
    write_png(path, png_of(*this, PNG_FORMAT_RGB), bytes.data(), nullptr);
}

void Image::save_png(const std::string& path, int colours) const {
    const IndexedPicture picture = with_few_colours(*this, colours);
    png_image png = png_of(*this, PNG_FORMAT_RGB_COLORMAP);
    png.colormap_entries = static_cast<png_uint_32>(picture.palette.size());
    write_png(path, png, picture.indices.data(), picture.palette.data());
}

Colour colour_scale(double value) {
    static const std::array<Colour, 6> stops = {
        Colour(0.16F, 0.18F, 0.42F), Colour(0.14F, 0.36F, 0.56F), Colour(0.12F, 0.53F, 0.55F),
        Colour(0.28F, 0.70F, 0.43F), Colour(0.65F, 0.83F, 0.25F), Colour(0.98F, 0.89F, 0.20F)};
    const double at = std::clamp(value, 0.0, 1.0) * (stops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    const auto part = static_cast<float>(at - static_cast<double>(low));
    return (1.0F - part) * stops[low] + part * stops[low + 1];
}

}  // namespace lpf::test
