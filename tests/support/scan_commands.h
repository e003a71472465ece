#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tests/support/render.h"
#include "tests/support/shapes.h"

namespace lpf::test {

/// What errors are measured against: a shape by name, or a file (a mesh, or the points of a cloud).
struct Reference {
    std::string shape = {};
    std::string file = {};

    [[nodiscard]] bool empty() const { return shape.empty() && file.empty(); }
};

struct SimulateCommand {
    std::string shape = "curvenet";
    std::string mesh = {};  ///< file of a mesh to sample instead of `shape`
    Sampling sampling = {};
    double noise_percent = 0.0;  ///< of the diagonal; instead of sampling.noise
    std::string output = {};
    std::string clean_output = {};  ///< empty: none
};

struct ErrorCommand {
    std::string result = {};
    Reference reference = {};
    bool detailed = false;       ///< also by part, coverage and spacing
    double edge_distance = 0.0;  ///< how far "near a sharp edge" reaches; 0: not told
};

struct RenderCommand {
    std::vector<std::string> inputs = {};
    std::vector<std::string> labels = {};
    std::string output = {};
    PictureSize size = {1200, 600};
    std::vector<double> direction = {-60, 30};  ///< azimuth, elevation
    std::vector<double> zoom = {};              ///< x, y, z, extent; empty: all points
    std::string colour = "height";  ///< height, plain, distance, rgb, or an attribute's name
    Reference reference = {};       ///< for colour = distance
    double colour_limit = 0.0;      ///< distance at the end of the scale; 0 = the largest
};

/// Writes a noisy scan of a shape, and its clean twin if asked. Returns what was written.
nlohmann::ordered_json simulate(const SimulateCommand& command);

/// Distances from a result to the reference, in input units and in per cent of the diagonal.
/// Details tell them by part (surface, curve, near sharp edges), and the way back: coverage of each
/// part.
nlohmann::ordered_json measure_error(const ErrorCommand& command);

/// Draws files side by side.
nlohmann::ordered_json render_files(const RenderCommand& command);

}  // namespace lpf::test
