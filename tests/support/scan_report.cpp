#include "tests/support/scan_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lpf::test {

using json = nlohmann::ordered_json;

json to_json(const ErrorStats& stats, double diagonal) {
    const auto percent = [&](double length) { return diagonal > 0 ? 100 * length / diagonal : 0; };
    return {{"rmse", stats.rmse},
            {"mean", stats.mean},
            {"p95", stats.p95},
            {"max", stats.max},
            {"percentOfDiagonal",
             {{"rmse", percent(stats.rmse)},
              {"mean", percent(stats.mean)},
              {"p95", percent(stats.p95)},
              {"max", percent(stats.max)}}}};
}

json to_json(const PartErrors& errors) {
    json parts = json::object();
    const auto add = [&](const char* name, const ErrorStats& stats) {
        if (stats.count > 0) parts[name] = {{"points", stats.count}, {"rmse", stats.rmse}};
    };
    add("surface", errors.surface);
    add("curve", errors.curve);
    add("nearEdges", errors.near_edges);
    return parts;
}

json to_json(const ShapeCoverage& coverage) {
    json parts = json::object();
    const auto add = [&](const char* name, double distance) {
        if (!std::isnan(distance)) parts[name] = distance;
    };
    add("surface", coverage.surface);
    add("curve", coverage.curve);
    add("border", coverage.border);
    add("end", coverage.end);
    add("edge", coverage.edge);
    return parts;
}

json to_json(const NeighbourStats& stats) {
    return {{"mean", stats.mean},
            {"variation", stats.mean > 0 ? stats.deviation / stats.mean : 0.0},
            {"min", stats.min},
            {"max", stats.max}};
}

}  // namespace lpf::test
