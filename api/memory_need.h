#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "api/job_inputs.h"
#include "api/shape_info.h"

namespace lpf {

/// Memory that a job may need, told from what is known of its shape without a look at it [bytes].
struct MemoryRange {
    double least = 0;
    std::optional<double> most = {};  ///< nothing where only a look at the shape can tell
};
/// @param streaming_threads those of a job that does not hold its shape; 0 = it does
[[nodiscard]] MemoryRange memory_range(Task task, const JobInputs& inputs, const ShapeInfo& shape,
                                       int streaming_threads = 0);

/// For a look at a sample of the points [bytes].
inline constexpr double kLookBytes = 48e6;

/// Memory for decoding a file within a request and looking at it [bytes].
/// @throws as read_draco_claim
[[nodiscard]] double decoding_bytes(std::span<const std::byte> file, const Limits& limits);

/// The same for `summarize`, which holds a sample of the points at most.
[[nodiscard]] double summary_bytes(std::span<const std::byte> file, const Limits& limits);

/// @param needed estimate of a job [bytes]
/// @param budget of all jobs together [bytes]
/// @throws ProblemException{OutOfMemory} that names both, if the job could never start
void require_memory(double needed, std::uint64_t budget);

}  // namespace lpf
