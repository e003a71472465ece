#pragma once

#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

#include "core/base/progress.h"

namespace lpf {

/// How a computation runs: threads, cancellation, progress. Passed down, never global.
struct Execution {
    int threads = 1;            ///< threads to use, >= 1; results do not depend on it
    std::stop_token stop = {};  ///< asked once per chunk
    ProgressSink progress = {};
};

/// Runs `body(begin, end, chunk)` over [0, n) in fixed chunks of `chunk_size`, on `threads`
/// threads. The chunks do not depend on the number of threads: results that are merged in chunk
/// order are bit-identical for any number. The first exception of a body is rethrown after all
/// threads ended.
/// @throws Error{Cancelled} when the stop token fires
void parallel_for(const Execution& execution, std::size_t n, std::size_t chunk_size,
                  const std::function<void(std::size_t, std::size_t, std::size_t)>& body);

/// Chunks of loops that do little for each point of a cloud.
inline constexpr std::size_t kPointsPerChunk = 1U << 16U;

/// Number of chunks that `parallel_for` makes of n items.
[[nodiscard]] constexpr std::size_t chunk_count(std::size_t n, std::size_t chunk_size) {
    return (n + chunk_size - 1) / chunk_size;
}

/// @throws Error{Cancelled} when the stop token has fired
void throw_if_cancelled(const Execution& execution);

/// The same for a loop whose steps depend on each other: one thread, still in chunks that ask for
/// cancellation and tell progress.
[[nodiscard]] Execution on_one_thread(const Execution& execution);

/// The part [low, high] of the caller's progress bar as an Execution of its own, so that a
/// computation made of steps reports one rising fraction.
[[nodiscard]] Execution part_of(const Execution& execution, double low, double high);

/// The same for step number `step` of `steps` that take about as long each.
[[nodiscard]] Execution step_of(const Execution& execution, std::size_t step, std::size_t steps);

/// Reports that nothing is left to do.
void report_done(const Execution& execution, std::string_view phase, std::string_view unit);

/// Like parallel_for, and reports `phase` as chunks finish.
void parallel_for(const Execution& execution, std::string_view phase, std::string_view unit,
                  std::size_t n, std::size_t chunk_size,
                  const std::function<void(std::size_t, std::size_t, std::size_t)>& body);

}  // namespace lpf
