#include <utility>

#include "tests/paper/experiments.h"
#include "tests/support/chart.h"

namespace lpf::paper {
namespace {

const test::Colour kColours[] = {{0.16F, 0.18F, 0.42F},
                                 {0.12F, 0.53F, 0.55F},
                                 {0.45F, 0.70F, 0.20F},
                                 {0.90F, 0.60F, 0.10F},
                                 {0.75F, 0.15F, 0.20F}};

}  // namespace

TestShape analysed_head(const Settings& settings) {
    return test::make_head({.points = settings.points(400000), .noise = 0.01, .seed = 6});
}

Section convergence(const Settings& settings) {
    Section section{
        .title = "Fig. 6: convergence of the error for several sizes of the dictionary",
        .paper =
            "The energy of Eq. 2 over the iterations on the Brassempouy head (diagonal "
            "51.96, r = .7), for several d, divided by d to show them together. Without "
            "numbers; the curves fall, steeply at first.",
        .here =
            "That scan is not to be had: a head of the same diagonal with a face and rows of "
            "locks, 400 000 points, noise of .01; r = .7, M = 193, lambda = .2, the paper's "
            "probing operator, LPFs at least one radius apart so that the dictionary is "
            "learned on all of them, one round of coding and update in an iteration. Energy per "
            "LPF in units of the radius, after step 3 of an "
            "iteration (probed anew).",
        .tables = {{{"d", "1", "2", "5", "10", "20", "rises"}}}};
    const TestShape head = analysed_head(settings);
    std::vector<test::Series> lines;
    bool falls = true, more_is_better = true;
    double last = 1e9;
    for (const int atoms : {4, 8, 16, 32, 64}) {
        AnalysisParams params{.radius = 0.7,
                              .seed_spacing = 1.0,
                              .atoms = atoms,
                              .lambda = 0.2,
                              .iterations = 20,
                              .learning_rounds = 1};
        const AnalysisResult result = analyze(cloud_of(head.points), params, settings.execution);
        test::Series line{"D = " + std::to_string(atoms), {}, {}, kColours[lines.size()]};
        std::vector<Cell> row{std::to_string(atoms)};
        int rises = 0;
        for (std::size_t i = 0; i < result.energy.size(); ++i) {
            const double energy = result.energy[i].probing;
            rises += i > 0 && energy > result.energy[i - 1].probing;
            line.x.push_back(double(i + 1));
            line.y.push_back(energy / atoms);
            if (i == 0 || i == 1 || i == 4 || i == 9 || i == 19) row.push_back(number(energy));
        }
        row.push_back(number(rises, 1));
        falls &= result.energy.back().probing < result.energy.front().probing;
        more_is_better &=
            std::exchange(last, result.energy.back().probing) > result.energy.back().probing;
        section.tables[0].rows.push_back(std::move(row));
        lines.push_back(std::move(line));
    }
    section.note =
        "`rises` counts the iterations, of 20, after which the energy was higher than "
        "before; the paper's Sec. 3.6 allows for it.";
    section.claims = {{"the energy falls from the first iteration to the last, for each d", falls},
                      {"more atoms leave less energy", more_is_better}};
    add_picture(section, settings, "convergence", "Energy per LPF, divided by d.", [&] {
        return line_chart(lines, {"", "iteration", "energy / d"}, {640, 380});
    });
    return section;
}

}  // namespace lpf::paper
