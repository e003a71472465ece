#include "api/dictionary_document.h"

#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/analysis_json.h"
#include "api/link.h"

namespace lpf {
namespace {

using nlohmann::json;

float coordinate(const Dictionary& dictionary, int atom, int point, int channel) {
    const auto offset = static_cast<std::size_t>(channel * dictionary.pattern().padded_size());
    return dictionary.atom(atom)[offset + static_cast<std::size_t>(point)];
}

json points_to_json(const Pattern& pattern) {
    json points = json::array();
    for (int i = 0; i < pattern.size(); ++i) {
        const Eigen::Vector3f p = pattern.point(i);
        points.push_back({shortest(p.x()), shortest(p.y()), shortest(p.z())});
    }
    return points;
}

json atoms_to_json(const Dictionary& dictionary) {
    json atoms = json::array();
    for (int k = 0; k < dictionary.atoms(); ++k) {
        json atom = json::array();
        for (int i = 0; i < dictionary.pattern().size(); ++i) {
            atom.push_back({shortest(coordinate(dictionary, k, i, 0)),
                            shortest(coordinate(dictionary, k, i, 1)),
                            shortest(coordinate(dictionary, k, i, 2))});
        }
        atoms.push_back(std::move(atom));
    }
    return atoms;
}

json description(const DictionaryDocument& document) {
    json usage = json::array();
    for (const float share : document.usage) usage.push_back(shortest(share));
    json result = {{"radius", document.radius},
                   {"lambda", document.lambda},
                   {"usage", std::move(usage)},
                   {"energy", energy_to_json(document.energy)},
                   {"energySteps", energy_steps_to_json(document.energy)},
                   {"created", to_rfc3339(document.created)}};
    const int grid_size = document.dictionary.pattern().grid_size();
    result["pattern"]["kind"] = grid_size > 0 ? "grid" : "points";
    if (grid_size > 0) result["pattern"]["gridSize"] = grid_size;
    if (!document.id.empty()) result["id"] = document.id;
    if (!document.source_job.empty()) result["sourceJob"] = document.source_job;
    return result;
}

}  // namespace

DictionaryDocument make_dictionary_document(const AnalysisResult& analysis, std::string id,
                                            std::string source_job, UnixMillis created) {
    return {.id = std::move(id),
            .dictionary = analysis.dictionary,
            .radius = analysis.radius,
            .lambda = analysis.lambda,
            .usage = analysis.usage,
            .energy = analysis.energy,
            .source_job = std::move(source_job),
            .created = created};
}

json to_json(const DictionaryDocument& document) {
    json result = description(document);
    result["patternPoints"] = points_to_json(document.dictionary.pattern());
    result["atoms"] = atoms_to_json(document.dictionary);
    return result;
}

json summary_to_json(const DictionaryDocument& document) {
    json result = description(document);
    result["patternPoints"] = document.dictionary.pattern().size();
    result["atoms"] = document.dictionary.atoms();
    const std::string self = "/v1/dictionaries/" + document.id;
    result["links"] = {
        to_json(Link{.href = self, .rel = "self"}),
        to_json(
            Link{.href = self + "/data", .rel = "enclosure", .title = "Pattern points and atoms"})};
    return result;
}

json dictionary_list_to_json(const std::vector<json>& summaries) {
    return {{"dictionaries", summaries},
            {"links", json::array({to_json(Link{.href = "/v1/dictionaries", .rel = "self"})})}};
}

std::string atoms_to_npy(const Dictionary& dictionary) {
    static_assert(std::endian::native == std::endian::little, "NumPy's '<f4' is little-endian");
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                         std::to_string(dictionary.atoms()) + ", " +
                         std::to_string(dictionary.pattern().size()) + ", 3), }";
    constexpr std::size_t kPreamble = 10;
    constexpr std::size_t kAlignment = 64;
    while ((kPreamble + header.size() + 1) % kAlignment != 0) header += ' ';
    header += '\n';
    std::string file("\x93NUMPY\x01\x00", 8);
    file += static_cast<char>(header.size() & 0xFF);
    file += static_cast<char>(header.size() >> 8);
    file += header;
    for (int k = 0; k < dictionary.atoms(); ++k) {
        for (int i = 0; i < dictionary.pattern().size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                const float value = coordinate(dictionary, k, i, c);
                char bytes[sizeof value];
                std::memcpy(bytes, &value, sizeof value);
                file.append(bytes, sizeof value);
            }
        }
    }
    return file;
}

}  // namespace lpf
