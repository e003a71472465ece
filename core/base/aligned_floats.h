#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace lpf {

/// Allocates at the start of a line of the cache. Loads of a whole vector register that begin
/// anywhere else take in two lines, and half the rate.
template <class T>
struct LineAllocator {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};

    LineAllocator() = default;
    template <class Other>
    explicit LineAllocator(const LineAllocator<Other>&) {}

    [[nodiscard]] T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new(n * sizeof(T), kLine));
    }
    void deallocate(T* at, std::size_t) { ::operator delete(at, kLine); }

    template <class Other>
    bool operator==(const LineAllocator<Other>&) const {
        return true;
    }
};

/// What the kernels run over.
using AlignedFloats = std::vector<float, LineAllocator<float>>;

/// So many floats rounded up to whole lines of the cache, so that rows of them all begin at one.
[[nodiscard]] constexpr std::size_t whole_lines(std::size_t floats) {
    return (floats + 15) / 16 * 16;
}

}  // namespace lpf
