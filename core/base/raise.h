#pragma once

#include <atomic>
#include <cstdint>

namespace lpf {

/// Raises a mark that several threads may raise at once: the highest stays, whatever their order.
inline void raise(std::uint8_t& mark, std::uint8_t to) {
    const std::atomic_ref<std::uint8_t> shared(mark);
    std::uint8_t now = shared.load(std::memory_order_relaxed);
    while (now < to && !shared.compare_exchange_weak(now, to, std::memory_order_relaxed)) {
    }
}

}  // namespace lpf
