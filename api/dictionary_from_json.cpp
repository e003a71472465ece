#include <cmath>
#include <nlohmann/json.hpp>

#include "api/dictionary_document.h"
#include "core/base/error.h"

namespace lpf {
namespace {

using nlohmann::json;

constexpr float kNormTolerance = 1e-3F;

[[noreturn]] void malformed(const std::string& name, const std::string& should) {
    throw Error(ErrorCode::MalformedFile, "The dictionary's " + name + " must be " + should + ".",
                name);
}

const json& member(const json& document, const char* name) {
    const auto found = document.find(name);
    if (found == document.end()) malformed(name, "there");
    return *found;
}

double number(const json& value, const char* name) {
    if (!value.is_number() || !std::isfinite(value.get<double>()))
        malformed(name, "finite numbers");
    return value.get<double>();
}

double number_or_zero(const json& document, const char* name) {
    return document.contains(name) ? number(document[name], name) : 0.0;
}

/// An array of triples: 3 x M.
Eigen::Matrix3Xf read_triples(const json& rows, const char* name) {
    Eigen::Matrix3Xf points(3, static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].is_array() || rows[i].size() != 3) malformed(name, "rows of three numbers");
        for (std::size_t c = 0; c < 3; ++c) {
            points(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i)) =
                static_cast<float>(number(rows[i][c], name));
        }
    }
    return points;
}

void check_count(const json& rows, const char* name, std::uint64_t limit) {
    if (!rows.is_array() || rows.empty()) malformed(name, "an array with at least one entry");
    if (rows.size() <= limit) return;
    throw Error(ErrorCode::LimitExceeded,
                "The dictionary has " + std::to_string(rows.size()) + " " + name +
                    "; the limit is " + std::to_string(limit) + ".",
                name);
}

/// A file that holds no pattern is at fault itself, and not the parameter of a request.
Pattern pattern_of(const Eigen::Matrix3Xf& points) {
    try {
        return Pattern::from_points(points);
    } catch (const Error& error) {
        throw Error(ErrorCode::MalformedFile,
                    std::string("The dictionary's patternPoints are no pattern. ") + error.what(),
                    "patternPoints");
    }
}

Pattern read_pattern(const json& document, const Limits& limits) {
    const json& rows = member(document, "patternPoints");
    check_count(rows, "patternPoints", limits.pattern_points);
    const Eigen::Matrix3Xf points = read_triples(rows, "patternPoints");
    const json pattern = document.value("pattern", json::object());
    if (!pattern.is_object() || pattern.value("kind", json()) != "grid") {
        return pattern_of(points);
    }
    const json size = pattern.value("gridSize", json());
    if (!size.is_number_integer()) malformed("pattern", "a grid with its gridSize");
    const auto wide = size.get<std::int64_t>();
    if (wide < 4 || wide > 128) malformed("pattern", "a grid of gridSize 4 to 128");
    Pattern grid = Pattern::grid(static_cast<int>(wide));
    if (grid.size() != static_cast<int>(points.cols())) {
        throw Error(ErrorCode::IncompatibleDictionary,
                    "A grid of gridSize " + std::to_string(wide) + " has " +
                        std::to_string(grid.size()) + " points; the dictionary has " +
                        std::to_string(points.cols()) + " patternPoints.",
                    "patternPoints");
    }
    return grid;
}

void read_atom(const json& rows, int k, Dictionary& dictionary) {
    const auto count = static_cast<std::size_t>(dictionary.pattern().size());
    if (!rows.is_array() || rows.size() != count) {
        throw Error(ErrorCode::IncompatibleDictionary,
                    "Atom " + std::to_string(k) + " of the dictionary must have " +
                        std::to_string(count) + " rows, one per pattern point.",
                    "atoms");
    }
    const Eigen::Matrix3Xf values = read_triples(rows, "atoms");
    if (!(values.norm() <= 1.0F + kNormTolerance)) malformed("atoms", "of norm 1 at most");
    const auto stride = static_cast<std::size_t>(dictionary.pattern().padded_size());
    const std::span<float> atom = dictionary.atom(k);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            atom[c * stride + i] =
                values(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(i));
        }
    }
}

Dictionary read_dictionary(const json& document, const Limits& limits) {
    const json& atoms = member(document, "atoms");
    check_count(atoms, "atoms", limits.atoms);
    Dictionary dictionary(read_pattern(document, limits), static_cast<int>(atoms.size()));
    for (int k = 0; k < dictionary.atoms(); ++k) {
        read_atom(atoms[static_cast<std::size_t>(k)], k, dictionary);
    }
    return dictionary;
}

void read_story(const json& document, DictionaryDocument& result) {
    const json none = json::array();
    const json usage = document.value("usage", none);
    if (!usage.empty() && usage.size() != static_cast<std::size_t>(result.dictionary.atoms())) {
        throw Error(ErrorCode::IncompatibleDictionary,
                    "The dictionary's usage must have one entry per atom.", "usage");
    }
    for (const json& share : usage) {
        result.usage.push_back(static_cast<float>(number(share, "usage")));
    }
    for (const json& step : document.value("energySteps", none)) {
        if (!step.is_object()) malformed("energySteps", "objects");
        result.energy.push_back({.learning = number_or_zero(step, "learning"),
                                 .pose = number_or_zero(step, "pose"),
                                 .probing = number_or_zero(step, "probing")});
    }
}

std::string text_or_empty(const json& document, const char* name) {
    const json value = document.value(name, json(""));
    if (!value.is_string()) malformed(name, "a string");
    return value.get<std::string>();
}

}  // namespace

DictionaryDocument dictionary_from_json(const json& json_document, const Limits& limits) {
    if (!json_document.is_object()) malformed("document", "a JSON object");
    DictionaryDocument result{.id = text_or_empty(json_document, "id"),
                              .dictionary = read_dictionary(json_document, limits),
                              .radius = number_or_zero(json_document, "radius"),
                              .lambda = number_or_zero(json_document, "lambda"),
                              .usage = {},
                              .energy = {},
                              .source_job = text_or_empty(json_document, "sourceJob"),
                              .created = 0};
    read_story(json_document, result);
    result.created = from_rfc3339(text_or_empty(json_document, "created")).value_or(0);
    return result;
}

}  // namespace lpf
