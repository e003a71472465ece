#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace lpf::test {

using Colour = Eigen::Vector3f;  ///< red, green, blue, 0 to 1, as displayed (sRGB)

/// A picture, row by row from the top left.
class Image {
public:
    Image(int width, int height, const Colour& background);

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] Colour& at(int x, int y) { return pixels_[index(x, y)]; }
    [[nodiscard]] const Colour& at(int x, int y) const { return pixels_[index(x, y)]; }

    /// The picture at half the size, each pixel the mean of four.
    [[nodiscard]] Image halved() const;

    /// Copies `other` with its top left corner at (x, y). @pre it fits
    void paste(const Image& other, int x, int y);

    /// Writes `text` with strokes; letters are `size` pixels high. Unknown characters are blanks.
    void write(const std::string& text, int x, int y, double size, const Colour& colour);

    /// Draws a straight line with round ends, `width` pixels wide.
    void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width,
              const Colour& colour);

    /// @throws Error{StorageFailure} if the file cannot be written
    void save_png(const std::string& path) const;

    /// The same in `colours` colours at most, 1 to 256: a much smaller file.
    void save_png(const std::string& path, int colours) const;

private:
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    int width_;
    int height_;
    std::vector<Colour> pixels_;
};

/// Dark blue over green to yellow for 0 to 1; equal steps look equally far apart.
[[nodiscard]] Colour colour_scale(double value);

}  // namespace lpf::test
