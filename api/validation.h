#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/attribute_plan.h"
#include "api/estimate.h"
#include "api/job.h"
#include "api/limits.h"
#include "core/shape/noise.h"

namespace lpf {

/// How many neighbours points have within the radius.
struct NeighbourCounts {
    double radius = 0;                  ///< [input length]
    std::vector<std::uint32_t> counts;  ///< of a sample of the points, ascending

    /// The count that a share of the points does not exceed. 0 if nothing was counted.
    [[nodiscard]] std::uint32_t quantile(double share) const;
};

/// What POST /v1/processes/{id}/validate answers.
struct Validation {
    Task process = Task::Denoise;
    std::string shape;  ///< ID, if it was named by one
    std::string format;
    std::uint64_t points = 0;
    std::uint64_t faces = 0;
    double examined_share = 1;  ///< of the points
    JobInputs parameters;
    std::vector<ResolvedParameter> resolved_parameters;
    Measurements measurements;
    NeighbourCounts neighbours;
    std::vector<AttributePlan> attributes;
    Workload work;
    Estimate estimate;
    int threads = 1;
    std::vector<Warning> warnings;
};

/// Numbers of points that the warnings are about.
struct OddPoints {
    double duplicates = 0;
    double outliers = 0;
    bool has_normals = false;
};

/// What a job may take.
struct Allowance {
    double seconds = 0;
    double memory_bytes = 0;  ///< 0: any amount
};

/// What the user should know before the job runs.
/// @param rules what the rules of the parameters warn of
[[nodiscard]] std::vector<Warning> foresee(const Validation& validation, const OddPoints& odd,
                                           const std::vector<std::string>& rules,
                                           const Allowance& allowed);

[[nodiscard]] nlohmann::json to_json(const Validation& validation);

}  // namespace lpf
