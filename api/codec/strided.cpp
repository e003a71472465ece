#include "api/codec/strided.h"

#include <algorithm>
#include <cstring>

namespace lpf {
namespace {

template <std::size_t Size>
void copy_values(std::size_t n, const std::byte* source, std::size_t source_stride,
                 std::byte* target, std::size_t target_stride) {
    for (std::size_t i = 0; i < n; ++i) {
        std::memcpy(target + i * target_stride, source + i * source_stride, Size);
    }
}

template <std::size_t Size>
void swap_values(std::span<std::byte> values) {
    for (std::size_t i = 0; i + Size <= values.size(); i += Size) {
        std::reverse(values.data() + i, values.data() + i + Size);
    }
}

}  // namespace

void copy_strided(std::size_t size, std::size_t n, const std::byte* source,
                  std::size_t source_stride, std::byte* target, std::size_t target_stride) {
    switch (size) {
        case 1: return copy_values<1>(n, source, source_stride, target, target_stride);
        case 2: return copy_values<2>(n, source, source_stride, target, target_stride);
        case 4: return copy_values<4>(n, source, source_stride, target, target_stride);
        default: return copy_values<8>(n, source, source_stride, target, target_stride);
    }
}

void swap_bytes(std::size_t size, std::span<std::byte> values) {
    switch (size) {
        case 2: return swap_values<2>(values);
        case 4: return swap_values<4>(values);
        case 8: return swap_values<8>(values);
        default: return;
    }
}

}  // namespace lpf
