#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/parallel.h"

namespace lpf {

template <typename Key>
using Keyed = std::pair<Key, std::uint32_t>;

/// Stable sort by key, on all threads; only as many passes as the largest key needs. The standard
/// library's parallel sort takes several times as long for keys of few bits.
/// @param room as many items, overwritten
/// @throws Error{Cancelled}
template <typename Key>
void radix_sort(std::vector<Keyed<Key>>& items, std::vector<Keyed<Key>>& room,
                std::uint64_t largest_key, const Execution& execution);

extern template void radix_sort(std::vector<Keyed<std::uint32_t>>&,
                                std::vector<Keyed<std::uint32_t>>&, std::uint64_t,
                                const Execution&);
extern template void radix_sort(std::vector<Keyed<std::uint64_t>>&,
                                std::vector<Keyed<std::uint64_t>>&, std::uint64_t,
                                const Execution&);

}  // namespace lpf
