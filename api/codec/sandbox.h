#pragma once

#include <cstdint>

namespace lpf {

/// What a helper process may use at most.
struct SandboxLimits {
    std::uint64_t memory_bytes = 0;  ///< of address space, and of what it writes
    unsigned cpu_seconds = 0;
    unsigned wall_seconds = 0;
};

/// Confines this process before it looks at a stranger's bytes: no more than the limits, no new
/// file, no new privilege, no core dump, and no system calls but those that computing needs. One
/// that breaks out of this ends by a signal. Under sanitizers, which reserve terabytes of address
/// space and look around in the system, only time and files are limited.
/// @throws Error{Internal}
void confine_this_process(const SandboxLimits& limits);

}  // namespace lpf
