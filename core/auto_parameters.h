#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/denoise.h"
#include "core/resample.h"
#include "core/shape/noise.h"

namespace lpf {

enum class Task { Denoise, Resample, Analyze };

/// What a user asked for; everything left empty is chosen from the data. Lengths in the input's
/// unit.
struct ParameterRequest {
    std::optional<double> radius;
    std::optional<int> pattern_points;
    std::optional<int> atoms;
    std::optional<double> lambda;
    std::optional<int> analysis_iterations;
    std::optional<int> denoise_iterations;
    std::optional<double> gamma;
    std::optional<double> target_spacing;
    std::optional<std::size_t> target_points;
    std::optional<double> factor;  ///< target points as a multiple of the input's
    std::optional<ProbingKind> probing;
    std::uint64_t random_seed = 1;
    std::optional<Dictionary> dictionary;  ///< to start from; fixes pattern and atoms
    bool keep_dictionary = false;
};

/// A value and where it came from, for the user to read.
struct ResolvedValue {
    std::string name;  ///< as in ParameterRequest
    double value = 0.0;
    bool automatic = false;  ///< false: the user gave it
    std::string rule;        ///< one sentence: how it was found
};

/// The parameters of a job, each with its origin.
struct ResolvedParameters {
    DenoiseParams denoise;    ///< filled for Task::Denoise
    ResampleParams resample;  ///< filled for Task::Resample
    AnalysisParams analysis;  ///< filled for every task
    std::vector<ResolvedValue> values;
    std::vector<std::string> warnings;  ///< e.g. a radius that holds too few points
};

/// Chooses what was left open (rules in docs/parameters.md).
/// @throws Error{InvalidParameter} for a value out of range or contradicting targets
[[nodiscard]] ResolvedParameters resolve_parameters(Task task, const Shape& shape,
                                                    const Measurements& measurements,
                                                    const ParameterRequest& request);

}  // namespace lpf
