#include "tests/paper/document.h"

#include <algorithm>
#include <sstream>

namespace lpf::paper {
namespace {

constexpr const char* kOpening =
    R"(# The experiments of the paper

All experiments of *Sparse Geometric Representation Through Local Shape Probing* (Digne, Valette,
Chaine, 2018) that give a result, each under the name of its figure, table or section. This page,
its numbers and its pictures are written by

```
scripts/paper.sh --fandisk fandisk.ply
```

and by nothing else. The paper's scans are not part of the project: shapes made here stand in for
them, for which the exact answer is known, so that errors can be measured where the paper shows
pictures. Errors are distances from the points to the exact shape, RMSE their root mean square, in the
unit of the shape and, of more than 400 000 points, of every k-th; coverage is the RMS distance the other way, from the exact shape to the points. Parameters called
automatic are what the service chooses when nothing is given. After each experiment stands what the
paper says about it, and whether the numbers above bear it out; the program decides that, not the
author of this page.

)";

constexpr const char* kLeftOut = R"(## Left out

Figs. 2, 3 and 9 explain the method with drawings. The results of EAR, MLS, bilateral filters and
other methods are not made anew.
)";

std::size_t held(const Section& section) {
    return static_cast<std::size_t>(
        std::ranges::count_if(section.claims, [](const Claim& claim) { return claim.holds; }));
}

}  // namespace

std::string document(const std::vector<Finished>& finished, const Origin& origin) {
    std::ostringstream out;
    double seconds = 0.0;
    std::size_t claims = 0, holding = 0;
    std::string list = "| experiment | statements of the paper | that hold |\n|---|---|---|\n";
    for (const Finished& each : finished) {
        const std::size_t count = each.section.claims.size(), yes = held(each.section);
        seconds += each.seconds;
        claims += count;
        holding += yes;
        list += "| " + each.section.title + " | " + std::to_string(count) + " | " +
                std::to_string(yes) + " |\n";
    }
    out << kOpening << "Measured on " << origin.machine << ", " << origin.threads
        << " threads, at commit " << origin.commit << ", in " << number(seconds / 60, 2).text
        << " minutes. Of " << claims << " statements " << holding << " hold.\n\n"
        << list << "\n";
    for (const Finished& each : finished) out << markdown(each.section, each.seconds) << "\n";
    out << kLeftOut;
    if (!origin.not_run.empty()) {
        out << "\nNot run this time:";
        for (const std::string& name : origin.not_run) out << " `" << name << "`";
        out << ".\n";
    }

    return out.str();
}

}  // namespace lpf::paper
