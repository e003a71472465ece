#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/field_set.h"
#include "tests/paper/experiments.h"

namespace lpf::paper {

Section stability(const Settings& settings) {
    const int runs = settings.runs(50);
    Section section{
        .title = "Sec. 3.3: stability over random initial dictionaries",
        .paper =
            "50 runs with the same parameters, each from another random dictionary: the "
            "energy of Eq. 3 divided by N has a mean of 3.2 and a standard deviation of "
            ".007. Shape and parameters are not stated.",
        .here =
            "The head of Fig. 6, d = 32, LPFs at the same first poses in every run, all of "
            "them learned on, 10 iterations; only the LPFs that the first dictionary is drawn "
            "from differ. The energy is in units of the radius, so that its deviation "
            "relative to its mean is what compares.",
        .tables = {
            {{"", "runs", "mean", "standard deviation", "deviation / mean", "least", "largest"}}}};
    const TestShape head = analysed_head(settings);
    AnalysisParams params{.radius = 0.7,
                          .seed_spacing = 1.0,
                          .atoms = 32,
                          .lambda = 0.2,
                          .iterations = 10,
                          .learning_rounds = 1};
    const Shape shape = cloud_of(head.points);
    FieldSet fields(shape, params, settings.execution);
    fields.optimise_poses(params.pose_iterations, settings.execution);
    const std::vector<Frame> poses = fields.frames;
    params.learning_sample = static_cast<int>(fields.size());

    std::vector<double> energies;
    for (int i = 0; i < runs; ++i) {
        fields.frames = poses;
        params.random_seed = static_cast<std::uint64_t>(1000 + i);
        energies.push_back(analyze(fields, params, settings.execution).energy.back().learning);
    }
    const double n = runs;
    const double mean = std::accumulate(energies.begin(), energies.end(), 0.0) / n;
    double squares = 0.0;
    for (const double energy : energies) squares += (energy - mean) * (energy - mean);
    const double deviation = std::sqrt(squares / (n - 1));
    const auto [least, largest] = std::ranges::minmax(energies);
    section.tables[0].rows = {{"paper", number(50, 2), number(3.2, 2), number(0.007, 1),
                               number(0.007 / 3.2, 2), "-", "-"},
                              {"here", number(n, 2), number(mean, 4), number(deviation, 2),
                               number(deviation / mean, 2), number(least, 4), number(largest, 4)}};
    section.claims = {{"the result is stable: the deviation is below one per cent of the mean",
                       deviation < 0.01 * mean},
                      {"it is as stable as the paper's: the relative deviation is not larger",
                       deviation / mean <= 0.007 / 3.2}};
    return section;
}

}  // namespace lpf::paper
