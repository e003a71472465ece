#include "server/cores.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <thread>

namespace lpf::server {
namespace {

int whole_cores(double quota, double period) {
    return quota > 0 && period > 0 ? std::max(1, static_cast<int>(std::ceil(quota / period))) : 0;
}

double number_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    double value = 0;
    return in >> value ? value : 0;
}

int affinity_cores() {
    cpu_set_t set;
    CPU_ZERO(&set);
    return ::sched_getaffinity(0, sizeof(set), &set) == 0 ? CPU_COUNT(&set) : 0;
}

}  // namespace

int cgroup_cores(const std::filesystem::path& root) {
    std::ifstream unified(root / "cpu.max");  // version 2: "max 100000" or "150000 100000"
    double quota = 0;
    double period = 0;
    if (unified >> quota >> period) return whole_cores(quota, period);
    const auto legacy = root / "cpu";
    return whole_cores(number_in(legacy / "cpu.cfs_quota_us"),
                       number_in(legacy / "cpu.cfs_period_us"));
}

int usable_cores() {
    int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    for (const int limit : {affinity_cores(), cgroup_cores("/sys/fs/cgroup")})
        if (limit > 0) cores = std::min(cores, limit);
    return cores;
}

}  // namespace lpf::server
