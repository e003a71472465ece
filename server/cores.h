#pragma once

#include <filesystem>

namespace lpf::server {

/// Cores that this process may use: the machine's, its affinity mask, and the CPU quota of its
/// container (cgroup version 1 or 2), whichever is least; at least 1.
[[nodiscard]] int usable_cores();

/// The quota alone, rounded up to whole cores; 0 if there is none.
/// @param root where the control groups are mounted, /sys/fs/cgroup
[[nodiscard]] int cgroup_cores(const std::filesystem::path& root);

}  // namespace lpf::server
