#include "server/cores.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace lpf::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRoot = "/sys/fs/cgroup";

int whole_cores(double quota, double period) {
    return quota > 0 && period > 0 ? std::max(1, static_cast<int>(std::ceil(quota / period))) : 0;
}

double number_in(const fs::path& file) {
    std::ifstream in(file);
    double value = 0;
    return in >> value ? value : 0;
}

int affinity_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    return ::sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 0;
}

/// The folders of the process's group and of all above it, for a controller of version 1 or, with
/// an empty name, for version 2. In a container the mount often begins at the process's own group,
/// so that the path in `own` leads nowhere and the root alone is left.
std::vector<fs::path> groups(const fs::path& root, const std::string& controller,
                             const fs::path& own) {
    std::string path;
    std::ifstream list(own);  // lines "4:memory:/a/b"; of version 2 "0::/a/b"
    for (std::string line; std::getline(list, line);) {
        const auto first = line.find(':');
        const auto second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        // "cpu,cpuacct" has several names; that of version 2 is empty.
        const std::string names = "," + line.substr(first + 1, second - first - 1) + ",";
        if (names.find("," + controller + ",") != std::string::npos) path = line.substr(second + 1);
    }
    const fs::path top = controller.empty() ? root : root / controller;
    std::vector<fs::path> folders{top};
    fs::path folder = top;
    for (const auto& part : fs::path(path).relative_path()) folders.push_back(folder /= part);
    return folders;
}

/// The least that is no 0, or 0.
template <typename Value>
Value stricter(Value a, Value b) {
    if (a == 0 || b == 0) return std::max(a, b);
    return std::min(a, b);
}

}  // namespace

int cgroup_cores(const fs::path& root, const fs::path& own) {
    int cores = 0;
    for (const auto& group : groups(root, "", own)) {
        std::ifstream unified(group / "cpu.max");  // "max 100000" or "150000 100000"
        double quota = 0;
        double period = 0;
        if (unified >> quota >> period) cores = stricter(cores, whole_cores(quota, period));
    }
    for (const auto& group : groups(root, "cpu", own)) {
        const double quota = number_in(group / "cpu.cfs_quota_us");  // -1: none
        cores = stricter(cores, whole_cores(quota, number_in(group / "cpu.cfs_period_us")));
    }
    return cores;
}

std::uint64_t cgroup_memory(const fs::path& root, const fs::path& own) {
    constexpr double kNone = 1e18;  // version 1 writes a number near 2^63 for no limit
    double bytes = 0;
    const auto consider = [&](double limit) {
        if (limit > 0 && limit < kNone) bytes = stricter(bytes, limit);
    };
    for (const auto& group : groups(root, "", own)) consider(number_in(group / "memory.max"));
    for (const auto& group : groups(root, "memory", own))
        consider(number_in(group / "memory.limit_in_bytes"));
    return static_cast<std::uint64_t>(bytes);
}

int usable_cores() {
    int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (const int limit : {affinity_cores(), cgroup_cores(kRoot)})
        cores = std::max(1, stricter(cores, limit));
    return cores;
}

std::uint64_t usable_memory() {
    const auto pages = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PHYS_PAGES)));
    const auto size = static_cast<std::uint64_t>(std::max(0L, ::sysconf(_SC_PAGESIZE)));
    return stricter(pages * size, cgroup_memory(kRoot));
}

}  // namespace lpf::server
