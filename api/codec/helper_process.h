#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/codec/memory_file.h"

namespace lpf {

/// The three streams of a helper process.
struct HelperStreams {
    MemoryFile in;
    MemoryFile out;
    MemoryFile error;
};

/// Runs a program on the streams and waits for its end. It inherits nothing else: no descriptor, no
/// environment (but the options of sanitizers, if this program is built with one), no signal mask.
/// @param arguments  the path of the program first
/// @param phase  what it does, for the progress: seconds of those that it may take
/// @param wall_seconds  it is killed some seconds after this time, which it should keep by itself
/// @returns its status, as waitpid gives it
/// @throws Error{Cancelled} at once when the stop token fires: the process is killed
/// @throws Error{Internal} if it cannot be started
[[nodiscard]] int run_helper(const std::vector<std::string>& arguments,
                             const HelperStreams& streams, std::string_view phase,
                             unsigned wall_seconds, const Execution& execution);

}  // namespace lpf
