#include "tests/paper/experiments.h"

namespace lpf::paper {

Section timing(const Settings& settings) {
    Section section{
        .title = "Sec. 4.3: time of an analysis",
        .paper =
            "1.1 million points, 100 000 LPFs of M = 193 points and d = 32 atoms take 30 s to "
            "set up and 150 s for 10 iterations, on a 4-core laptop (Core i7).",
        .here =
            "1.1 million points of the shape of Table 1, radius .225 and LPFs half a radius "
            "apart, which gives about as many of them; the paper's M, d, lambda and "
            "iterations and its probing operator, all in one call. The dictionary is learned "
            "on 8192 LPFs (the program's default), the paper's on all.",
        .tables = {{{"", "points", "LPFs", "threads", "seconds"}}}};
    const TestShape shape =
        test::make_curvenet({.points = settings.points(1100000), .noise = 0.05, .seed = 43});
    const AnalysisParams params{.radius = 0.225, .atoms = 32, .lambda = 0.2, .iterations = 10};
    std::size_t fields = 0;
    const double seconds = seconds_of([&] {
        fields = analyze(cloud_of(shape.points), params, settings.execution).frames.size();
    });
    section.tables[0].rows = {
        {"paper", number(1100000, 2), number(100000, 1), number(4, 1), number(180, 3)},
        {"here", number(double(shape.points.cols()), 2), number(double(fields), 3),
         number(settings.execution.threads, 1), number(seconds, 3)}};
    section.claims = {{"it is faster than the paper's", seconds < 180}};
    return section;
}

}  // namespace lpf::paper
