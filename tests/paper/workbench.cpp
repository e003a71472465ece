#include "tests/paper/workbench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/shape/normals.h"
#include "tests/paper/errors.h"
#include "tests/support/metrics.h"

namespace lpf::paper {
namespace {

using test::Colour;
using test::Image;
using test::Scene;
using test::View;

constexpr Eigen::Index kMostDrawn = 250'000;
constexpr std::uintmax_t kLargestPicture = 150'000;  // bytes: they are kept with the sources
constexpr int kSmallDictionary = 8;

/// The points that a view shows, at most kMostDrawn of them.
Points visible(const Points& points, const View& view) {
    std::vector<Eigen::Index> inside;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if ((points.col(i) - view.centre).norm() < 1.5 * view.extent) inside.push_back(i);
    }
    return thinned(points(Eigen::all, inside), kMostDrawn);
}

Scene scene_of(Points points, std::vector<Colour> colours, const std::string& label) {
    Eigen::Matrix3Xf normals = estimate_normals(points, 16, {.threads = 2});
    return {std::move(points), std::move(normals), std::move(colours), label};
}

}  // namespace

std::size_t Settings::points(std::size_t in_paper) const {
    return static_cast<std::size_t>(std::lround(size * static_cast<double>(in_paper)));
}

int Settings::runs(int in_paper) const {
    return std::max(2, static_cast<int>(std::lround(size * in_paper)));
}

ParameterRequest paper_request(double radius, int pattern_points, int atoms) {
    ParameterRequest request;
    request.radius = radius;
    request.pattern_points = pattern_points;
    request.atoms = atoms;
    request.lambda = atoms <= kSmallDictionary ? 0.05 : 0.2;
    request.analysis_iterations = 10;
    return request;
}

double seconds_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Shape cloud_of(const Points& points) { return {{points, {}}, {}}; }

Denoised denoise_with(const Points& points, const ParameterRequest& request,
                      const Settings& settings) {
    Denoised done;
    done.seconds = seconds_of([&] {
        const Shape shape = cloud_of(points);
        const Measurements measured = measure(points, settings.execution);
        const DenoiseParams params =
            resolve_parameters(Task::Denoise, shape, measured, request).denoise;
        done.radius = params.analysis.radius;
        done.points = denoise(shape, params, settings.execution).points;
    });
    return done;
}

Resampled resample_with(const Shape& shape, const ParameterRequest& request,
                        const Settings& settings,
                        const std::function<void(ResampleParams&)>& adjust) {
    Resampled done;
    done.seconds = seconds_of([&] {
        const Measurements measured = measure(shape.cloud.points, settings.execution);
        ResampleParams params =
            resolve_parameters(Task::Resample, shape, measured, request).resample;
        if (adjust) adjust(params);
        ResampleResult result = resample(shape, params, settings.execution);
        done.points = std::move(result.points);
        done.spacing = result.spacing;
    });
    return done;
}

Scene plain_scene(const Points& points, const std::string& label, const View& view) {
    Points shown = visible(points, view);
    const auto count = static_cast<std::size_t>(shown.cols());
    return scene_of(std::move(shown), std::vector<Colour>(count, Colour(0.80F, 0.76F, 0.68F)),
                    label);
}

Scene distance_scene(const Points& points, const TestShape& shape, double limit,
                     const std::string& label, const View& view) {
    Points shown = visible(points, view);
    std::vector<Colour> colours;
    for (const double distance : test::distances_of(
             shown, [&](const test::Vector3d& point) { return shape.distance(point); })) {
        colours.push_back(0.7F * test::colour_scale(distance / limit) + Colour::Constant(0.3F));
    }
    return scene_of(std::move(shown), std::move(colours), label);
}

Image plain_pair(const TestShape& input, const Points& result, const View& view,
                 const test::PictureSize& size) {
    return render_side_by_side(
        {plain_scene(input.points, "input", view), plain_scene(result, "resampled", view)}, view,
        size);
}

Image distance_pair(const TestShape& input, const Points& result, double limit,
                    const std::pair<std::string, std::string>& labels, const View& view,
                    const test::PictureSize& size) {
    return render_side_by_side({distance_scene(input.points, input, limit, labels.first, view),
                                distance_scene(result, input, limit, labels.second, view)},
                               view, size);
}

Image below_each_other(const std::vector<Image>& rows) {
    int width = 0, height = 0;
    for (const Image& row : rows) {
        width = std::max(width, row.width());
        height += row.height();
    }
    Image picture(width, height, Colour(1, 1, 1));
    int y = 0;
    for (const Image& row : rows) {
        picture.paste(row, 0, y);
        y += row.height();
    }
    return picture;
}

Image beside_each_other(const std::vector<Image>& images) {
    int width = 0, height = 0;
    for (const Image& image : images) {
        width += image.width();
        height = std::max(height, image.height());
    }
    Image picture(width, height, Colour(1, 1, 1));
    int x = 0;
    for (const Image& image : images) {
        picture.paste(image, x, 0);
        x += image.width();
    }
    return picture;
}

void add_picture(Section& section, const Settings& settings, const std::string& name,
                 const std::string& caption, const std::function<Image()>& draw) {
    if (settings.picture_folder.empty()) return;
    const std::string path = settings.picture_folder + "/" + name + ".png";
    const Image picture = draw();
    for (int colours = 256; colours >= 16; colours /= 2) {
        picture.save_png(path, colours);
        if (std::filesystem::file_size(path) < kLargestPicture) break;
    }
    section.pictures.push_back({settings.picture_link + "/" + name + ".png", caption});
}

}  // namespace lpf::paper
