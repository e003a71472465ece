#include "api/measurements_json.h"

#include <nlohmann/json.hpp>

namespace lpf {

nlohmann::json to_json(const Measurements& measured) {
    const NoiseMap& map = measured.noise_map;
    return {{"diagonal", measured.diagonal},
            {"meanSpacing", measured.mean_spacing},
            {"noise", measured.noise},
            {"leastNoise", map.least() * measured.noise},
            {"mostNoise", map.most() * measured.noise},
            {"densityRadius", measured.density_radius}};
}

}  // namespace lpf
