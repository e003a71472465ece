#include "tests/bench/jobs/cost_meter.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <fstream>

namespace lpf::bench {
namespace {

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double cpu_of(int who) {
    rusage usage{};
    ::getrusage(who, &usage);
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

CostMeter::Moment CostMeter::now() {
    const auto wall = std::chrono::steady_clock::now().time_since_epoch();
    return {cpu_of(RUSAGE_SELF) + cpu_of(RUSAGE_CHILDREN),
            std::chrono::duration<double>(wall).count()};
}

CostMeter::CostMeter() : since_(now()) {}

void CostMeter::begin(const std::string& phase) {
    if (phase == running_) return;
    end();
    running_ = phase;
    since_ = now();
}

void CostMeter::end() {
    if (running_.empty()) return;
    const Moment end = now();
    auto cost = std::ranges::find(costs_, running_, &Cost::phase);
    if (cost == costs_.end()) cost = costs_.insert(cost, Cost{.phase = running_});
    cost->cpu_seconds += end.cpu - since_.cpu;
    cost->wall_seconds += end.wall - since_.wall;
    running_.clear();
}

Cost CostMeter::total() const {
    Cost total{.phase = "total"};
    for (const Cost& cost : costs_) {
        total.cpu_seconds += cost.cpu_seconds;
        total.wall_seconds += cost.wall_seconds;
    }
    return total;
}

double peak_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        double kibibytes = 0;
        if (word == "VmHWM:" && status >> kibibytes) return 1024 * kibibytes;
    }
    return 0;
}

}  // namespace lpf::bench
