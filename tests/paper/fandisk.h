#pragma once

#include "tests/paper/workbench.h"
#include "tests/support/metrics.h"

namespace lpf::paper {

/// The mesh that stands for the Fandisk.
struct FandiskBody {
    Shape mesh;
    std::string what;             ///< in words
    test::MeshDistance to_edges;  ///< to its sharp edges
    Points on_edges;              ///< 3 x K, places along them

    /// One for each point within `reach` of a sharp edge.
    [[nodiscard]] std::vector<std::uint8_t> near_edges(const Points& points, double reach) const;
};

/// The paper's own mesh if it was given, else the body that is made here.
[[nodiscard]] FandiskBody fandisk_body(const Settings& settings);

}  // namespace lpf::paper
