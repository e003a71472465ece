#pragma once

#include <cstdint>
#include <filesystem>

namespace lpf::server {

/// Cores that this process may use: the machine's, its affinity mask, and the CPU quota of its
/// container (cgroup version 1 or 2), whichever is least; at least 1.
[[nodiscard]] int usable_cores();

/// Memory that this process may use, in bytes: the machine's, or the limit of its container.
[[nodiscard]] std::uint64_t usable_memory();

/// The CPU quota alone, rounded up to whole cores; 0 if there is none.
/// @param root where the control groups are mounted, /sys/fs/cgroup
/// @param own  the list of the groups that the process is in; those above them count, too
[[nodiscard]] int cgroup_cores(const std::filesystem::path& root,
                               const std::filesystem::path& own = "/proc/self/cgroup");

/// The memory limit alone, in bytes; 0 if there is none. Parameters as of cgroup_cores.
[[nodiscard]] std::uint64_t cgroup_memory(const std::filesystem::path& root,
                                          const std::filesystem::path& own = "/proc/self/cgroup");

}  // namespace lpf::server
