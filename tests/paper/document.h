#pragma once

#include <string>
#include <vector>

#include "tests/paper/section.h"

namespace lpf::paper {

/// A finished experiment and the time that it took.
struct Finished {
    Section section;
    double seconds = 0.0;
};

/// Where and on what the numbers were measured.
struct Origin {
    std::string machine = "an unnamed machine";
    std::string commit = "unknown";
    int threads = 2;
    std::vector<std::string> not_run = {};  ///< experiments that were left out this time
};

/// The whole document: how it was made, a list of all claims, the experiments, what is left out.
[[nodiscard]] std::string document(const std::vector<Finished>& finished, const Origin& origin);

}  // namespace lpf::paper
