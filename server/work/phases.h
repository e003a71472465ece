#pragma once

#include <string>
#include <utility>
#include <vector>

#include "server/clock.h"

namespace lpf::server {

/// Where on the progress bar each part of a job ends [percent].
inline constexpr double kDecoded = 3;
inline constexpr double kPrepared = 5;
inline constexpr double kMeasured = 8;
inline constexpr double kComputed = 90;
inline constexpr double kWritten = 99;

/// Notes how long each phase took, for the report.
class PhaseTimes {
public:
    void end_of(const std::string& phase) {
        seconds_.emplace_back(phase, seconds_since(start_));
        start_ = Clock::now();
    }
    [[nodiscard]] const auto& seconds() const { return seconds_; }

private:
    Clock::time_point start_ = Clock::now();
    std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace lpf::server
