#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/job.h"
#include "api/shape_info.h"
#include "core/analysis.h"
#include "core/shape/noise.h"

namespace lpf {

/// How far points went [input length].
struct DisplacementStatistics {
    double rms = 0.0;
    double mean = 0.0;
    double p50 = 0.0;
    double p90 = 0.0;
    double p99 = 0.0;
    double max = 0.0;
};

/// Distances between the columns of two point sets. All zero if they are empty.
/// @pre as many columns in both
[[nodiscard]] DisplacementStatistics displacement_statistics(const Points& before,
                                                             const Points& after);

/// The same of the distances themselves.
[[nodiscard]] DisplacementStatistics displacement_statistics(std::vector<float> lengths);

/// What was done, found and measured: the result `report` of a job.
struct Report {
    std::string version;  ///< of the program
    std::string job_id;
    Task process = Task::Denoise;
    std::uint64_t input_points = 0;
    std::uint64_t input_faces = 0;
    std::uint64_t output_points = 0;
    std::optional<Bounds> input_bounds;
    std::optional<Bounds> output_bounds;
    Measurements measurements;
    std::vector<ResolvedParameter> resolved_parameters;
    std::uint64_t fields = 0;  ///< number of LPFs
    std::vector<IterationEnergy> energy;
    std::vector<double> rms_moves;  ///< of each outer iteration of denoising [input length]
    std::optional<DisplacementStatistics> displacement;
    std::uint64_t outliers = 0;                                 ///< found
    std::uint64_t duplicates = 0;                               ///< found
    std::uint64_t non_finite = 0;                               ///< dropped
    std::vector<std::pair<std::string, double>> phase_seconds;  ///< in order of running
    double total_seconds = 0.0;
    int threads = 0;
    std::optional<std::uint64_t> peak_memory_bytes;
    std::vector<Warning> warnings;
};

[[nodiscard]] nlohmann::json to_json(const Report& report);

}  // namespace lpf
