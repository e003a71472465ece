#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/auto_parameters.h"
#include "tests/paper/section.h"
#include "tests/support/render.h"
#include "tests/support/shapes.h"

namespace lpf::paper {

using test::Sampling;
using test::TestShape;

/// What all experiments share: how large they are, where their pictures go, how they run.
struct Settings {
    Execution execution = {.threads = 2};
    double size = 1.0;                  ///< share of the paper's numbers of points and runs
    std::optional<Shape> fandisk = {};  ///< the paper's mesh; without it, a body made here
    std::string picture_folder = {};    ///< empty: no pictures are drawn
    std::string picture_link = {};      ///< the same folder as the document sees it

    [[nodiscard]] std::size_t points(std::size_t in_paper) const;
    [[nodiscard]] int runs(int in_paper) const;
};

/// The parameters that the paper states for a figure. Its lambda is .2, and .05 for small
/// dictionaries (Sec. 3.3); its analysis takes 10 iterations.
[[nodiscard]] ParameterRequest paper_request(double radius, int pattern_points, int atoms);

/// NaN, shown as "-", for points as they were scanned.
constexpr double kNotSet = std::numeric_limits<double>::quiet_NaN();

struct Denoised {
    Points points;
    double radius = kNotSet;
    double seconds = kNotSet;
};
[[nodiscard]] Denoised denoise_with(const Points& points, const ParameterRequest& request,
                                    const Settings& settings);

struct Resampled {
    Points points;
    double spacing = kNotSet;
    double seconds = kNotSet;
};
/// @param adjust the last word on the parameters, for what a request cannot say
[[nodiscard]] Resampled resample_with(const Shape& shape, const ParameterRequest& request,
                                      const Settings& settings,
                                      const std::function<void(ResampleParams&)>& adjust = {});

[[nodiscard]] Shape cloud_of(const Points& points);

/// Seconds that `work` takes.
[[nodiscard]] double seconds_of(const std::function<void()>& work);

// Pictures. All are thinned to what can be seen of them.

[[nodiscard]] test::Scene plain_scene(const Points& points, const std::string& label,
                                      const test::View& view);

/// Coloured by the distance to the exact shape: dark 0, yellow `limit` and more.
[[nodiscard]] test::Scene distance_scene(const Points& points, const TestShape& shape, double limit,
                                         const std::string& label, const test::View& view);

/// Input and result of a resampling side by side.
[[nodiscard]] test::Image plain_pair(const TestShape& input, const Points& result,
                                     const test::View& view, const test::PictureSize& size);

/// The same, coloured by the distance to the exact shape.
[[nodiscard]] test::Image distance_pair(const TestShape& input, const Points& result, double limit,
                                        const std::pair<std::string, std::string>& labels,
                                        const test::View& view, const test::PictureSize& size);

/// Rows of pictures below each other, as wide as the widest.
[[nodiscard]] test::Image below_each_other(const std::vector<test::Image>& rows);

/// Images side by side.
[[nodiscard]] test::Image beside_each_other(const std::vector<test::Image>& images);

/// Saves a picture as FOLDER/NAME.png and adds it to the section.
void add_picture(Section& section, const Settings& settings, const std::string& name,
                 const std::string& caption, const std::function<test::Image()>& draw);

}  // namespace lpf::paper
