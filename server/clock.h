#pragma once

#include <chrono>

#include "api/time_text.h"

namespace lpf::server {

/// The time of day, as it is stored and shown.
[[nodiscard]] inline UnixMillis now_millis() {
    using std::chrono::duration_cast;
    return duration_cast<std::chrono::milliseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

/// Time for measuring and for deadlines: never steps.
using Clock = std::chrono::steady_clock;

[[nodiscard]] inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace lpf::server
