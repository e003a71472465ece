// Runs one method of CGAL's Point Set Processing on a PLY file, on one thread:
//
//   cgal-peer bilateral IN OUT neighbours= angle= iterations=
//   cgal-peer jet       IN OUT neighbours= iterations=
//   cgal-peer wlop      IN OUT percent= radius= iterations=
//   cgal-peer ear       IN OUT neighbours= angle= iterations= sensitivity= radius= points=
//
// ear smooths by bilateral (neighbours, iterations) before it upsamples. Angles are in degrees,
// lengths in the units of the file.

#include <CGAL/IO/read_ply_points.h>
#include <CGAL/IO/write_ply_points.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/bilateral_smooth_point_set.h>
#include <CGAL/edge_aware_upsample_point_set.h>
#include <CGAL/jet_smooth_point_set.h>
#include <CGAL/pca_estimate_normals.h>
#include <CGAL/property_map.h>
#include <CGAL/wlop_simplify_and_regularize_point_set.h>

#include <exception>
#include <fstream>
#include <iostream>
#include <iterator>
#include <utility>
#include <vector>

#include "tests/bench/peers/settings.h"

namespace lpf::peers {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Oriented = std::pair<Point, Kernel::Vector_3>;
using PointMap = CGAL::First_of_pair_property_map<Oriented>;
using NormalMap = CGAL::Second_of_pair_property_map<Oriented>;
using Tag = CGAL::Sequential_tag;

std::vector<Point> read(const std::string& path) {
    std::vector<Point> points;
    std::ifstream file(path, std::ios::binary);
    if (!file || !CGAL::IO::read_PLY(file, std::back_inserter(points)) || points.empty()) {
        throw std::runtime_error(path + " cannot be read");
    }
    return points;
}

void write(const std::string& path, const std::vector<Point>& points) {
    std::ofstream file(path, std::ios::binary);
    CGAL::IO::set_binary_mode(file);
    if (!CGAL::IO::write_PLY(file, points) || !file.flush()) {
        throw std::runtime_error(path + " cannot be written");
    }
}

auto maps() { return CGAL::parameters::point_map(PointMap()).normal_map(NormalMap()); }

std::vector<Oriented> smoothed_by_bilateral(const std::vector<Point>& points,
                                            const Settings& settings) {
    const unsigned neighbours = settings.count("neighbours");
    std::vector<Oriented> oriented;
    for (const Point& point : points) oriented.emplace_back(point, Kernel::Vector_3());
    for (unsigned i = 0; i < settings.count("iterations"); ++i) {
        // Normals estimated anew are better than those that the smoothing leaves behind.
        CGAL::pca_estimate_normals<Tag>(oriented, neighbours, maps());
        CGAL::bilateral_smooth_point_set<Tag>(oriented, neighbours,
                                              maps().sharpness_angle(settings.number("angle")));
    }
    return oriented;
}

std::vector<Point> positions(const std::vector<Oriented>& oriented) {
    std::vector<Point> points;
    for (const auto& [point, normal] : oriented) points.push_back(point);
    return points;
}

std::vector<Point> jet(std::vector<Point> points, const Settings& settings) {
    for (unsigned i = 0; i < settings.count("iterations"); ++i) {
        CGAL::jet_smooth_point_set<Tag>(points, settings.count("neighbours"));
    }
    return points;
}

std::vector<Point> wlop(std::vector<Point> points, const Settings& settings) {
    std::vector<Point> result;
    CGAL::wlop_simplify_and_regularize_point_set<Tag>(
        points, std::back_inserter(result),
        CGAL::parameters::select_percentage(settings.number("percent"))
            .neighbor_radius(settings.number("radius"))
            .number_of_iterations(settings.count("iterations")));
    return result;
}

std::vector<Point> ear(const std::vector<Point>& points, const Settings& settings) {
    const std::vector<Oriented> smooth = smoothed_by_bilateral(points, settings);
    std::vector<Oriented> result = smooth;  // CGAL gives the new points only
    CGAL::edge_aware_upsample_point_set<Tag>(
        smooth, std::back_inserter(result),
        maps()
            .sharpness_angle(settings.number("angle"))
            .edge_sensitivity(settings.number("sensitivity"))
            .neighbor_radius(settings.number("radius"))
            .number_of_output_points(settings.count("points")));
    return positions(result);
}

std::vector<Point> processed(const std::string& method, const std::vector<Point>& points,
                             const Settings& settings) {
    if (method == "bilateral") return positions(smoothed_by_bilateral(points, settings));
    if (method == "jet") return jet(points, settings);
    if (method == "wlop") return wlop(points, settings);
    if (method == "ear") return ear(points, settings);
    throw std::invalid_argument("no method '" + method + "': bilateral, jet, wlop, ear");
}

}  // namespace
}  // namespace lpf::peers

int main(int argc, char** argv) {
    try {
        if (argc < 4) throw std::invalid_argument("usage: cgal-peer METHOD IN OUT NAME=NUMBER ...");
        using namespace lpf::peers;
        write(argv[3], processed(argv[1], read(argv[2]), Settings(argc, argv, 4)));
    } catch (const std::exception& error) {
        std::cerr << "cgal-peer: " << error.what() << '\n';
        return 1;
    }
}
