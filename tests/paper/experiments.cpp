#include "tests/paper/experiments.h"

namespace lpf::paper {

const std::vector<Experiment>& experiments() {
    static const std::vector<Experiment> all = {
        {"ship", ship},
        {"sharp_features", sharp_features},
        {"sinusoid", sinusoid},
        {"convergence", convergence},
        {"stability", stability},
        {"atoms_of_cube", atoms_of_cube},
        {"cube_with_curve", cube_with_curve},
        {"sphere_radius", sphere_radius},
        {"fandisk_resampling", fandisk_resampling},
        {"facade", facade},
        {"mire", mire},
        {"shutter", shutter},
        {"pyramid", pyramid},
        {"plane", plane},
        {"fandisk_denoising", fandisk_denoising},
        {"cube_denoising", cube_denoising},
        {"head_denoising", head_denoising},
        {"curvenet", curvenet},
        {"timing", timing},
    };
    return all;
}

}  // namespace lpf::paper
