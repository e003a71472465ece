#include <utility>

#include "core/base/error.h"
#include "tests/support/shapes.h"

namespace lpf::test {
namespace {

using Maker = TestShape (*)(const Sampling&);

const std::vector<std::pair<std::string, Maker>>& makers() {
    static const std::vector<std::pair<std::string, Maker>> table = {
        {"plane", make_plane},
        {"sphere", make_sphere},
        {"cube", [](const Sampling& sampling) { return make_cube(sampling); }},
        {"thin_plate", [](const Sampling& sampling) { return make_thin_plate(sampling); }},
        {"fin", [](const Sampling& sampling) { return make_fin(sampling); }},
        {"crossing_curves", make_crossing_curves},
        {"curve_on_surface", make_curve_on_surface},
        {"cube_with_curve", make_cube_with_curve},
        {"open_sheet", make_open_sheet},
        {"density_step", make_density_step},
        {"isolated_points", make_isolated_points},
        {"line", make_line},
        {"circle", make_circle},
        {"helix", make_helix},
        {"curvenet", make_curvenet},
        {"pyramid", make_pyramid},
        {"disk_segment", make_disk_segment},
        {"head", make_head},
        {"shutter", make_shutter},
    };
    return table;
}

}  // namespace

const std::vector<std::string>& shape_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const auto& [name, maker] : makers()) result.push_back(name);
        return result;
    }();
    return names;
}

TestShape make_shape(const std::string& name, const Sampling& sampling) {
    std::string known;
    for (const auto& [known_name, maker] : makers()) {
        if (known_name == name) return maker(sampling);
        known += (known.empty() ? "" : ", ") + known_name;
    }
    throw Error(ErrorCode::InvalidParameter,
                "There is no shape '" + name + "'. Known shapes: " + known + ".", "shape");
}

}  // namespace lpf::test
