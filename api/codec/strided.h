#pragma once

#include <cstddef>
#include <span>

namespace lpf {

/// Copies `n` values of `size` bytes (1, 2, 4 or 8) between rows and columns: value i goes from
/// source + i * source_stride to target + i * target_stride.
void copy_strided(std::size_t size, std::size_t n, const std::byte* source,
                  std::size_t source_stride, std::byte* target, std::size_t target_stride);

/// Reverses the byte order of each value of `size` bytes (1, 2, 4 or 8).
void swap_bytes(std::size_t size, std::span<std::byte> values);

/// Rows that are moved at a time, so that a block stays in the processor's cache.
inline constexpr std::size_t kRowsPerBlock = 1024;

}  // namespace lpf
