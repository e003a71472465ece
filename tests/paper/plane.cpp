#include <algorithm>
#include <cmath>

#include "tests/paper/experiments.h"
#include "tests/support/chart.h"
#include "tests/support/metrics.h"

namespace lpf::paper {

Section plane(const Settings& settings) {
    Section section{
        .title = "Fig. 16: a plane resampled with patterns of three densities",
        .paper =
            "A randomly sampled plane is resampled with r = 1 and grids of 16, 32 and 64 "
            "nodes across. The mean distance of nearest neighbours is about the step of the "
            "grid, and the histogram that of Poisson disks.",
        .here =
            "A square of 2 x 2 with 60 000 random points, without noise. The "
            "paper's r = 1 is the diameter of the pattern (its step is given as .06 for 16 "
            "nodes), so the radius is .5. The least distance tau_p is one step.",
        .tables = {{{"pattern", "step", "mean distance, paper", "mean distance", "deviation",
                     "least", "largest", "within 1.25 steps"}}}};
    const TestShape shape = test::make_plane({.points = settings.points(60000), .seed = 11});
    const std::pair<int, double> cases[] = {{16, 0.075}, {32, 0.032}, {64, 0.015}};
    std::vector<test::Image> charts;
    bool means_agree = true, like_poisson_disks = true;
    for (const auto& [grid, mean] : cases) {
        ParameterRequest request;
        request.radius = 0.5;
        request.pattern_points = Pattern::grid(grid).size();
        request.target_spacing = 1.0 / grid;
        const Resampled result = resample_with(cloud_of(shape.points), request, settings);
        const auto stats = test::nearest_neighbour_stats(result.points);
        const auto near = std::ranges::count_if(
            stats.distances, [&](double distance) { return distance < 1.25 / grid; });
        const double share = double(near) / double(stats.distances.size());
        means_agree &= std::abs(stats.mean - mean) <= 0.15 * mean;
        like_poisson_disks &=
            stats.min >= (1 - 1e-6) / grid && stats.max <= 2.0 / grid && share >= 0.9;
        const std::string name = "M = " + std::to_string(*request.pattern_points);
        section.tables[0].rows.push_back({name, number(1.0 / grid), number(mean),
                                          number(stats.mean), number(stats.deviation, 2),
                                          number(stats.min), number(stats.max), percent(share)});
        charts.push_back(test::histogram(stats.distances, 0, 2.0 / grid, 40,
                                         {name, "distance", "% of points"}, {360, 260}));
    }
    add_picture(section, settings, "plane", "Histograms of the distance to the nearest neighbour.",
                [&] { return beside_each_other(charts); });
    section.claims = {{"the mean distance is within 15 % of the paper's", means_agree},
                      {"no two points are nearer than one step, nine of ten neighbours are within "
                       "1.25 steps, and none is beyond two: the histogram of Poisson disks",
                       like_poisson_disks}};
    return section;
}

}  // namespace lpf::paper
