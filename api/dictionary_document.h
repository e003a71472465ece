#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/limits.h"
#include "api/time_text.h"
#include "core/analysis.h"

namespace lpf {

/// A dictionary and the story of how it was learned.
struct DictionaryDocument {
    std::string id;  ///< UUIDv7; empty if it was never stored
    Dictionary dictionary;
    double radius = 0.0;  ///< r it was learned at [input length]
    double lambda = 0.0;
    std::vector<float> usage;             ///< d: share of LPFs that use the atom
    std::vector<IterationEnergy> energy;  ///< one per iteration
    std::string source_job;
    UnixMillis created = 0;
};

[[nodiscard]] DictionaryDocument make_dictionary_document(const AnalysisResult& analysis,
                                                          std::string id, std::string source_job,
                                                          UnixMillis created);

/// All of it: patternPoints M x 3 and atoms d x M x 3, both in units of the radius. A grid is named
/// by its size as well, so that it comes back as a grid.
[[nodiscard]] nlohmann::json to_json(const DictionaryDocument& document);

/// The description only, for lists: `atoms` and `patternPoints` are their numbers.
[[nodiscard]] nlohmann::json summary_to_json(const DictionaryDocument& document);

/// {dictionaries: [summaries], links}, from what summary_to_json made.
[[nodiscard]] nlohmann::json dictionary_list_to_json(const std::vector<nlohmann::json>& summaries);

/// The inverse of to_json, checked: sizes agree, all finite, atoms of norm <= 1, within the limits.
/// @throws lpf::Error{MalformedFile} for a missing or wrong member, {IncompatibleDictionary} for
///         sizes that do not fit each other, {LimitExceeded} for too many atoms or points
[[nodiscard]] DictionaryDocument dictionary_from_json(const nlohmann::json& json,
                                                      const Limits& limits);

/// The atoms as a NumPy file: little-endian float32, C order, shape (d, M, 3).
[[nodiscard]] std::string atoms_to_npy(const Dictionary& dictionary);

}  // namespace lpf
