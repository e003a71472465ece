#include "tests/support/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/support/metrics.h"

namespace lpf::test {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kGap = 8;  // pixels between panels
const Colour kPaper(1.0F, 1.0F, 1.0F);
const Colour kInk(0.15F, 0.17F, 0.20F);

/// Rows: right, up, towards the viewer.
Eigen::Matrix3d camera_axes(double azimuth, double elevation) {
    const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
    const Eigen::Vector3d right(-std::sin(a), std::cos(a), 0);
    const Eigen::Vector3d towards(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a),
                                  std::sin(e));
    Eigen::Matrix3d axes;
    axes << right.transpose(), towards.cross(right).transpose(), towards.transpose();
    return axes;
}

/// Mean distance of neighbours, on a sample.
double spacing_of(const Points& points) {
    if (points.cols() < 2) return 0.0;
    const CloudDistance nearest(points);
    const Eigen::Index step = std::max<Eigen::Index>(1, points.cols() / 500);
    std::vector<double> distances;
    for (Eigen::Index i = 0; i < points.cols(); i += step) {
        distances.push_back(nearest.to_others(points.col(i), static_cast<std::uint32_t>(i)));
    }
    return summarize(distances).mean;
}

/// One panel while it is drawn: what each pixel sees.
class Canvas {
public:
    Canvas(const Scene& scene, const View& view, const PictureSize& size)
        : scene_(scene),
          width_(size.width),
          height_(size.height),
          axes_(camera_axes(view.azimuth, view.elevation)),
          centre_(view.centre),
          scale_(std::min(size.width, size.height) / view.extent),
          spacing_(spacing_of(scene.points)),
          radius_(std::clamp(2.4 * spacing_ * scale_, 1.2, 24.0)),
          depth_(pixels(), kFar),
          normal_(pixels(), Eigen::Vector3f::Zero()),
          colour_(pixels(), Colour::Zero()),
          weight_(pixels(), 0.0F) {}

    Image draw() {
        splat([&](std::size_t pixel, Eigen::Index, float depth, float) {
            depth_[pixel] = std::min(depth_[pixel], depth);
        });
        const auto thickness = static_cast<float>(2.5 * spacing_ + 1.0 / scale_);
        splat([&](std::size_t pixel, Eigen::Index i, float depth, float weight) {
            if (depth > depth_[pixel] + thickness) return;
            normal_[pixel] += weight * facing_normal(i);
            colour_[pixel] += weight * scene_.colours[static_cast<std::size_t>(i)];
            weight_[pixel] += weight;
        });
        return shaded();
    }

private:
    std::size_t pixels() const {
        return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
    }

    /// Calls visit(pixel, point, depth, weight) for every pixel of every disc.
    template <typename Visit>
    void splat(const Visit& visit) const {
        for (Eigen::Index i = 0; i < scene_.points.cols(); ++i) {
            const Eigen::Vector3d p = axes_ * (scene_.points.col(i) - centre_) * scale_;
            const double cx = 0.5 * width_ + p.x(), cy = 0.5 * height_ - p.y();
            const int x0 = std::max(0, static_cast<int>(std::floor(cx - radius_)));
            const int x1 = std::min(width_ - 1, static_cast<int>(std::ceil(cx + radius_)));
            const int y0 = std::max(0, static_cast<int>(std::floor(cy - radius_)));
            const int y1 = std::min(height_ - 1, static_cast<int>(std::ceil(cy + radius_)));
            const auto depth = static_cast<float>(-p.z() / scale_);
            for (int y = y0; y <= y1; ++y) {
                for (int x = x0; x <= x1; ++x) {
                    const double off2 = std::pow(x + 0.5 - cx, 2) + std::pow(y + 0.5 - cy, 2);
                    const double inside = 1.0 - off2 / (radius_ * radius_);
                    if (inside <= 0) continue;
                    visit(static_cast<std::size_t>(y * width_ + x), i, depth,
                          static_cast<float>(inside * inside + 1e-3));
                }
            }
        }
    }

    Eigen::Vector3f facing_normal(Eigen::Index i) const {
        const Eigen::Vector3f n = axes_.cast<float>() * scene_.normals.col(i);
        return n.z() < 0 ? Eigen::Vector3f(-n) : n;
    }

    /// How much nearer the pixels around are: darkens rims and hollows (eye-dome lighting).
    float occlusion(int x, int y) const {
        static constexpr int kRing[8][2] = {{3, 0}, {-3, 0}, {0, 3},  {0, -3},
                                            {2, 2}, {-2, 2}, {2, -2}, {-2, -2}};
        const float here = depth_[static_cast<std::size_t>(y * width_ + x)];
        const auto reach = static_cast<float>(12.0 / scale_);
        float sum = 0;
        for (const auto& step : kRing) {
            const int u = std::clamp(x + step[0], 0, width_ - 1);
            const int v = std::clamp(y + step[1], 0, height_ - 1);
            const float there = depth_[static_cast<std::size_t>(v * width_ + u)];
            if (there < here) sum += std::min(1.0F, (here - there) / reach);
        }
        return sum / 8;
    }

    Image shaded() const {
        static const Eigen::Vector3f light = Eigen::Vector3f(-0.45F, 0.55F, 0.70F).normalized();
        Image image(width_, height_, kPaper);
        for (int y = 0; y < height_; ++y) {
            for (int x = 0; x < width_; ++x) {
                const auto pixel = static_cast<std::size_t>(y * width_ + x);
                if (weight_[pixel] <= 0) continue;
                const float diffuse = std::max(0.0F, normal_[pixel].normalized().dot(light));
                const float shade = (0.38F + 0.68F * diffuse) * (1 - 0.75F * occlusion(x, y));
                image.at(x, y) = shade * colour_[pixel] / weight_[pixel];
            }
        }
        return image;
    }

    const Scene& scene_;
    int width_, height_;
    Eigen::Matrix3d axes_;
    Eigen::Vector3d centre_;
    double scale_;  // pixels per unit of length
    double spacing_;
    double radius_;  // of a disc, in pixels
    std::vector<float> depth_;
    std::vector<Eigen::Vector3f> normal_;
    std::vector<Colour> colour_;
    std::vector<float> weight_;
};

}  // namespace

View fit_view(const Points& points, double azimuth, double elevation, double aspect) {
    View view{.azimuth = azimuth, .elevation = elevation};
    if (points.cols() == 0) return view;
    const Eigen::Matrix3d axes = camera_axes(azimuth, elevation);
    const Points seen = axes * points;
    const Eigen::Vector3d low = seen.rowwise().minCoeff(), high = seen.rowwise().maxCoeff();
    view.centre = axes.transpose() * (0.5 * (low + high));
    const double wide = high.x() - low.x(), tall = high.y() - low.y();
    const double needed =
        aspect >= 1 ? std::max(wide / aspect, tall) : std::max(wide, tall * aspect);
    view.extent = needed > 0 ? 1.06 * needed : 1.0;
    return view;
}

Image render(const Scene& scene, const View& view, const PictureSize& size) {
    Image image = Canvas(scene, view, {2 * size.width, 2 * size.height}).draw().halved();
    if (!scene.label.empty()) image.write(scene.label, 12, 12, 14, kInk);
    return image;
}

Image render_side_by_side(const std::vector<Scene>& scenes, const View& view,
                          const PictureSize& size) {
    const int count = std::max(1, static_cast<int>(scenes.size()));
    const int panel_width = (size.width - kGap * (count - 1)) / count;
    Image picture(size.width, size.height, kPaper);
    for (int i = 0; i < static_cast<int>(scenes.size()); ++i) {
        const Image panel =
            render(scenes[static_cast<std::size_t>(i)], view, {panel_width, size.height});
        picture.paste(panel, i * (panel_width + kGap), 0);
    }
    return picture;
}

}  // namespace lpf::test
