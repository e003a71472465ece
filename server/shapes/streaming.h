#pragma once

#include <optional>
#include <vector>

#include "api/codec/ply_points.h"
#include "api/job_inputs.h"
#include "api/limits.h"
#include "core/auto_parameters.h"
#include "server/store/mapped_file.h"

namespace lpf::server {

/// Limits of decoding that follow from those of the service.
[[nodiscard]] DecodeLimits decode_limits(const Limits& limits);

/// Whether a job reads its shape and writes its result part by part, so far as that depends on what
/// was asked for: a denoising that neither drops points nor changes their attributes.
[[nodiscard]] bool can_stream(Task task, const JobInputs& inputs);

/// The points of a shape that a job streams.
/// @param most points that a job may hold
/// @returns nothing where the job holds its shape: it is small, or the file or what is asked for
/// needs that
/// @throws as decode
[[nodiscard]] std::optional<PlyPoints> streamed_points(Task task, const JobInputs& inputs,
                                                       const MappedFile& file, const Limits& limits,
                                                       std::size_t most = kMostAtOnce);

/// How far each point went. @param finite how many points are; the others are left out
[[nodiscard]] std::vector<float> lengths_of(const std::vector<Eigen::Vector3f>& moves,
                                            std::size_t finite);

}  // namespace lpf::server
