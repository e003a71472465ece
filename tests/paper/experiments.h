#pragma once

#include <string>
#include <vector>

#include "tests/paper/workbench.h"

namespace lpf::paper {

// One function for each experiment of the paper, in files of their own.
Section ship(const Settings& settings);                // Fig. 1
Section sharp_features(const Settings& settings);      // Fig. 4
Section sinusoid(const Settings& settings);            // Fig. 5
Section convergence(const Settings& settings);         // Fig. 6
Section stability(const Settings& settings);           // Sec. 3.3
Section atoms_of_cube(const Settings& settings);       // Fig. 7
Section cube_with_curve(const Settings& settings);     // Fig. 8
Section sphere_radius(const Settings& settings);       // Fig. 10
Section fandisk_resampling(const Settings& settings);  // Fig. 11
Section facade(const Settings& settings);              // Fig. 12
Section mire(const Settings& settings);                // Fig. 13
Section shutter(const Settings& settings);             // Fig. 14
Section pyramid(const Settings& settings);             // Fig. 15
Section plane(const Settings& settings);               // Fig. 16
Section fandisk_denoising(const Settings& settings);   // Fig. 17
Section cube_denoising(const Settings& settings);      // Fig. 18
Section head_denoising(const Settings& settings);      // Fig. 19
Section curvenet(const Settings& settings);            // Fig. 20 and Table 1
Section timing(const Settings& settings);              // Sec. 4.3

/// The head on which Fig. 6 and Sec. 3.3 are rerun.
TestShape analysed_head(const Settings& settings);

struct Experiment {
    std::string name;
    Section (*run)(const Settings&);
};

/// All of them, in the order of the paper.
const std::vector<Experiment>& experiments();

}  // namespace lpf::paper
