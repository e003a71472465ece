#pragma once

#include <cstdint>

#include "server/http/message.h"
#include "server/services.h"

namespace lpf::server {

/// Memory that a job is to be given [bytes]: told from the shape's counts where that is little, and
/// otherwise from a look at the shape itself, which takes a second or two.
/// @throws ProblemException{OutOfMemory} if it is more than all jobs together may use
[[nodiscard]] std::uint64_t memory_for_job(Services& services, const http::Request& request,
                                           const StatusInfo& job, const ShapeInfo& shape);

}  // namespace lpf::server
