#include "tests/support/scan_commands.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/codec/format.h"
#include "core/base/error.h"
#include "core/shape/normals.h"
#include "tests/support/mesh_shape.h"
#include "tests/support/metrics.h"
#include "tests/support/scan_file.h"
#include "tests/support/scan_report.h"

namespace lpf::test {
namespace {

using json = nlohmann::ordered_json;  // the summary first, details after it
using Distance = std::function<double(const Vector3d&)>;

void write_points(const std::string& path, const Points& points) {
    Document document;
    document.shape.cloud.points = points;
    std::vector<Warning> lost;
    const std::string bytes = encode(document, {}, lost);
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file.flush()) throw Error(ErrorCode::StorageFailure, "Writing " + path + " failed.");
}

/// The distance function of a reference and the diagonal of what it measures to.
struct Target {
    Distance distance = {};
    double diagonal = 0.0;
    std::shared_ptr<const TestShape> shape = {};  ///< none if the reference is a cloud
};

Target target_of(const TestShape& exact) {
    const auto shape = std::make_shared<const TestShape>(exact);
    return {[shape](const Vector3d& p) { return shape->distance(p); }, shape->diagonal(), shape};
}

Target target_of(const Reference& reference) {
    if (!reference.shape.empty()) return target_of(make_shape(reference.shape, {.points = 1}));
    const Document document = read_scan(reference.file);
    if (document.shape.is_mesh()) return target_of(make_mesh_shape(document.shape, {.points = 1}));
    const Points& points = document.shape.cloud.points;
    return {CloudDistance(points), diagonal_of(points)};
}

/// Values on the colour scale, from the least to the largest.
std::vector<Colour> scaled_colours(const std::vector<double>& values, double low, double high) {
    std::vector<Colour> colours;
    const double span = high > low ? high - low : 1.0;
    for (const double value : values) colours.push_back(colour_scale((value - low) / span));
    return colours;
}

std::vector<Colour> scaled_colours(const std::vector<double>& values) {
    if (values.empty()) return {};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return scaled_colours(values, *low, *high);
}

std::vector<double> column(const PointCloud& cloud, const std::string& name) {
    for (const Attribute& attribute : cloud.attributes) {
        if (attribute.name != name || attribute.is_list()) continue;
        std::vector<double> values;
        for (std::size_t i = 0; i < cloud.size(); ++i) values.push_back(value_at(attribute, i));
        return values;
    }
    throw Error(ErrorCode::InvalidParameter,
                "The file has no attribute '" + name +
                    "'. --color takes height, plain, distance, rgb, or an attribute's name.",
                "color");
}

std::vector<Colour> rgb_colours(const PointCloud& cloud) {
    const std::vector<double> red = column(cloud, "red"), green = column(cloud, "green"),
                              blue = column(cloud, "blue");
    const double top = *std::max_element(red.begin(), red.end()) > 255 ? 65535 : 255;
    std::vector<Colour> colours;
    for (std::size_t i = 0; i < red.size(); ++i) {
        colours.push_back(Eigen::Vector3d(red[i], green[i], blue[i]).cast<float>() /
                          static_cast<float>(top));
    }
    return colours;
}

std::vector<Colour> colours_of(const PointCloud& cloud, const RenderCommand& command,
                               const Target& target) {
    if (command.colour == "plain") return {cloud.size(), Colour(0.80F, 0.76F, 0.68F)};
    if (command.colour == "rgb") return rgb_colours(cloud);
    if (command.colour == "height") {
        const auto heights = cloud.points.row(2);
        return scaled_colours({heights.begin(), heights.end()});
    }
    if (command.colour != "distance") return scaled_colours(column(cloud, command.colour));
    const std::vector<double> distances = distances_of(cloud.points, target.distance);
    const double limit = command.colour_limit > 0 ? command.colour_limit : summarize(distances).max;
    return scaled_colours(distances, 0, limit);
}

View view_of(const Points& points, const RenderCommand& command) {
    const auto panels = static_cast<double>(command.inputs.size());
    const double aspect = command.size.width / panels / command.size.height;
    View view = fit_view(points, command.direction.at(0), command.direction.at(1), aspect);
    if (!command.zoom.empty()) {
        view.centre = Vector3d(command.zoom.at(0), command.zoom.at(1), command.zoom.at(2));
        view.extent = command.zoom.at(3);
    }
    return view;
}

}  // namespace

json simulate(const SimulateCommand& command) {
    const auto make = [&](const Sampling& sampling) {
        return command.mesh.empty() ? make_shape(command.shape, sampling)
                                    : make_mesh_shape(read_mesh(command.mesh), sampling);
    };
    Sampling sampling = command.sampling;
    if (command.noise_percent > 0) {
        sampling.noise = command.noise_percent / 100 * make({.points = 1}).diagonal();
    }
    const TestShape shape = make(sampling);
    write_points(command.output, shape.points);
    if (!command.clean_output.empty()) write_points(command.clean_output, shape.clean);
    double area = 0.0;
    for (const PiecePtr& piece : shape.pieces) {
        if (piece->dimension() == 2) area += piece->measure();
    }
    const std::vector<std::uint8_t> on_curve = shape.on_curve();
    return {{"shape", command.mesh.empty() ? command.shape : command.mesh},
            {"points", sampling.points},
            {"noise", sampling.noise},
            {"noisePercentOfDiagonal", 100 * sampling.noise / shape.diagonal()},
            {"seed", sampling.seed},
            {"diagonal", shape.diagonal()},
            {"area", area},
            {"pointsOnCurves", std::count(on_curve.begin(), on_curve.end(), 1)},
            {"output", command.output}};
}

json measure_error(const ErrorCommand& command) {
    const Target target = target_of(command.reference);
    const Document result = read_scan(command.result);
    const Points& points = result.shape.cloud.points;
    const ErrorStats stats = summarize(distances_of(points, target.distance));
    json report = to_json(stats, target.diagonal);
    report["points"] = stats.count;
    report["diagonal"] = target.diagonal;
    report["reference"] =
        command.reference.shape.empty() ? command.reference.file : command.reference.shape;
    if (command.detailed && target.shape) {
        report["parts"] = to_json(error_by_part(points, *target.shape, command.edge_distance));
        report["coverage"] = to_json(coverage_of_shape(*target.shape, points));
    }
    if (command.detailed) report["spacing"] = to_json(nearest_neighbour_stats(points));
    return report;
}

json render_files(const RenderCommand& command) {
    Target target;
    if (!command.reference.empty()) target = target_of(command.reference);
    if (command.colour == "distance" && !target.distance) {
        throw Error(ErrorCode::InvalidParameter,
                    "--color distance needs --shape or --reference to measure to.", "color");
    }
    std::vector<Scene> scenes;
    for (std::size_t i = 0; i < command.inputs.size(); ++i) {
        const PointCloud cloud = read_scan(command.inputs[i]).shape.cloud;
        scenes.push_back({cloud.points, estimate_normals(cloud.points, 16, {.threads = 2}),
                          colours_of(cloud, command, target),
                          i < command.labels.size() ? command.labels[i] : ""});
    }
    const View view = view_of(scenes.at(0).points, command);
    render_side_by_side(scenes, view, command.size).save_png(command.output);
    return {{"output", command.output},
            {"width", command.size.width},
            {"height", command.size.height},
            {"extent", view.extent}};
}

}  // namespace lpf::test
