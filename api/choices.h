#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "api/job_inputs.h"

namespace lpf {

/// A named value of an enumeration, as it stands on the wire.
template <typename Enum>
struct Choice {
    std::string_view name;
    Enum value;
};

/// The values that a client may name, for every enumeration of JobInputs.
template <typename Enum>
inline constexpr std::span<const Choice<Enum>> kChoices = {};

inline constexpr Choice<RadiusUnit> kRadiusUnits[] = {{"absolute", RadiusUnit::Absolute},
                                                      {"spacing", RadiusUnit::Spacing},
                                                      {"diagonal", RadiusUnit::Diagonal}};
inline constexpr Choice<OutlierPolicy> kOutlierPolicies[] = {{"keep", OutlierPolicy::Keep},
                                                             {"mark", OutlierPolicy::Mark},
                                                             {"remove", OutlierPolicy::Remove}};
inline constexpr Choice<DuplicatePolicy> kDuplicatePolicies[] = {
    {"keep", DuplicatePolicy::Keep}, {"remove", DuplicatePolicy::Remove}};
inline constexpr Choice<AttributePolicy> kAttributePolicies[] = {{"keep", AttributePolicy::Keep},
                                                                 {"drop", AttributePolicy::Drop}};
inline constexpr Choice<NormalPolicy> kNormalPolicies[] = {{"keep", NormalPolicy::Keep},
                                                           {"estimate", NormalPolicy::Estimate},
                                                           {"drop", NormalPolicy::Drop}};
inline constexpr Choice<DictionaryMode> kDictionaryModes[] = {{"start", DictionaryMode::Start},
                                                              {"fixed", DictionaryMode::Fixed}};
inline constexpr Choice<ProbingKind> kProbingKinds[] = {
    {"orthogonal", ProbingKind::AsOrthogonalAsPossible},
    {"noiseAware", ProbingKind::NoiseAware},
    {"nearestPoint", ProbingKind::NearestPoint},
    {"nearestTriangle", ProbingKind::NearestTriangle}};
inline constexpr Choice<FileFormat> kResultFormats[] = {{"ply", FileFormat::PlyBinary},
                                                        {"ply-ascii", FileFormat::PlyAscii},
                                                        {"drc", FileFormat::Draco}};

template <>
inline constexpr std::span<const Choice<RadiusUnit>> kChoices<RadiusUnit> = kRadiusUnits;
template <>
inline constexpr std::span<const Choice<OutlierPolicy>> kChoices<OutlierPolicy> = kOutlierPolicies;
template <>
inline constexpr std::span<const Choice<DuplicatePolicy>> kChoices<DuplicatePolicy> =
    kDuplicatePolicies;
template <>
inline constexpr std::span<const Choice<AttributePolicy>> kChoices<AttributePolicy> =
    kAttributePolicies;
template <>
inline constexpr std::span<const Choice<NormalPolicy>> kChoices<NormalPolicy> = kNormalPolicies;
template <>
inline constexpr std::span<const Choice<DictionaryMode>> kChoices<DictionaryMode> =
    kDictionaryModes;
template <>
inline constexpr std::span<const Choice<ProbingKind>> kChoices<ProbingKind> = kProbingKinds;
template <>
inline constexpr std::span<const Choice<FileFormat>> kChoices<FileFormat> = kResultFormats;

/// "keep", "mark", ...: the names alone.
template <typename Enum>
[[nodiscard]] std::vector<std::string_view> choice_names() {
    std::vector<std::string_view> names;
    for (const auto& choice : kChoices<Enum>) names.push_back(choice.name);
    return names;
}

/// The name of a value; "auto" if it has none.
template <typename Enum>
[[nodiscard]] std::string_view choice_name(Enum value) {
    for (const auto& choice : kChoices<Enum>) {
        if (choice.value == value) return choice.name;
    }
    return "auto";
}

template <typename Enum>
[[nodiscard]] std::optional<Enum> choice_from_name(std::string_view name) {
    for (const auto& choice : kChoices<Enum>) {
        if (choice.name == name) return choice.value;
    }
    return std::nullopt;
}

}  // namespace lpf
