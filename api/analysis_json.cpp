#include "api/analysis_json.h"

#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

namespace lpf {

double shortest(float value) {
    std::array<char, 32> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value);
    double result = 0.0;
    std::from_chars(text.data(), written.ptr, result);
    return result;
}

nlohmann::json energy_to_json(const std::vector<IterationEnergy>& energy) {
    nlohmann::json json = nlohmann::json::array();
    for (const IterationEnergy& e : energy) json.push_back(e.probing);
    return json;
}

nlohmann::json energy_steps_to_json(const std::vector<IterationEnergy>& energy) {
    nlohmann::json json = nlohmann::json::array();
    for (const IterationEnergy& e : energy) {
        json.push_back({{"learning", e.learning}, {"pose", e.pose}, {"probing", e.probing}});
    }
    return json;
}

}  // namespace lpf
