#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/shape.h"
#include "tests/bench/accuracy/presentation.h"

namespace lpf::accuracy {

/// A number that is better the smaller it is, and the one that is aimed at.
struct Figure {
    std::string name;
    double value;
    double aim;
};

/// What a case is measured under.
struct Conditions {
    std::uint64_t seed = 1;  ///< of the points and their noise
    Presentation presentation = {};
    std::optional<Shape> fandisk = {};  ///< the mesh; cases that need it have no figures without it
    Execution execution = {.threads = 2};
};

/// A scan with a known answer, denoised or resampled with no parameter given.
struct Case {
    std::string name;
    std::string what;  ///< points, noise, what is special
    std::function<std::vector<Figure>(const Conditions&)> measure;
};

[[nodiscard]] std::vector<Case> cases();

}  // namespace lpf::accuracy
