#pragma once

#include <exception>
#include <string>

#include "api/job.h"

namespace lpf::server {

/// What the client is told about an exception of the work.
[[nodiscard]] Problem problem_of(const std::exception_ptr& exception);

/// The text for the log: also what the client is not told.
[[nodiscard]] std::string what_of(const std::exception_ptr& exception);

/// Of a job that used up its time.
[[nodiscard]] Problem out_of_time();

/// The job as it is after its end.
/// @param retention how long results are kept [ms]
[[nodiscard]] StatusInfo succeeded(StatusInfo info, UnixMillis now, UnixMillis retention);
[[nodiscard]] StatusInfo failed(StatusInfo info, Problem problem, UnixMillis now,
                                UnixMillis retention);

}  // namespace lpf::server
