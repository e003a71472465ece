#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace lpf {

/// A moment of a long computation, as shown to the user.
struct Progress {
    std::string_view phase;  ///< what is being done, e.g. "pose", "learn", "encode", "vote"
    std::size_t done = 0;    ///< units finished in this phase
    std::size_t total = 0;   ///< units of this phase
    std::string_view unit;   ///< what is counted, e.g. "fields", "points"
    double fraction = 0.0;   ///< of the whole computation, 0 to 1, never falling
};

/// Called from one thread at a time, at least every second and at most about 20 times a second.
/// Must be quick and must not throw.
using ProgressSink = std::function<void(const Progress&)>;

}  // namespace lpf
