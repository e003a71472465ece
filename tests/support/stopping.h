#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace lpf {

/// Runs `work` and asks it to stop after a while.
/// @returns how long it went on after that; nothing if it was done before it could be stopped
/// @throws what work throws, but for Error{Cancelled}
inline std::optional<std::chrono::duration<double>> time_to_stop(
    std::chrono::milliseconds delay, const std::function<void(const Execution&)>& work) {
    using Clock = std::chrono::steady_clock;
    std::stop_source stop;
    Clock::time_point asked;
    std::jthread alarm([&](const std::stop_token& done) {
        const auto end = Clock::now() + delay;
        while (Clock::now() < end && !done.stop_requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        asked = Clock::now();
        stop.request_stop();
    });
    try {
        work({.threads = 2, .stop = stop.get_token()});
        return std::nullopt;
    } catch (const Error& error) {
        if (error.code() != ErrorCode::Cancelled) throw;
    }
    alarm.join();
    return Clock::now() - asked;
}

}  // namespace lpf
