#pragma once

#include <string>
#include <vector>

namespace lpf::bench {

/// What one phase took.
struct Cost {
    std::string phase;
    double cpu_seconds = 0.0;  ///< user and system, of this process and of its ended children
    double wall_seconds = 0.0;
};

/// Cuts the time of a process into phases: each goes on until the next begins.
class CostMeter {
public:
    CostMeter();

    /// Ends the phase that runs, if another one starts.
    void begin(const std::string& phase);
    void end();

    /// In the order in which they first began; what came more than once is summed.
    [[nodiscard]] const std::vector<Cost>& costs() const { return costs_; }
    [[nodiscard]] Cost total() const;

private:
    struct Moment {
        double cpu;
        double wall;
    };
    static Moment now();

    std::vector<Cost> costs_;
    std::string running_;
    Moment since_;
};

/// Most memory that this process has had in use [bytes].
[[nodiscard]] double peak_memory();

}  // namespace lpf::bench
