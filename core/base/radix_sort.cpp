#include "core/base/radix_sort.h"

#include <array>

namespace lpf {
namespace {

constexpr std::size_t kItemsPerChunk = 1U << 16U;
constexpr unsigned kBits = 11;
constexpr std::size_t kBuckets = 1U << kBits;

using Counts = std::array<std::uint32_t, kBuckets>;

template <typename Key>
std::size_t bucket_of(const Keyed<Key>& item, unsigned shift) {
    return static_cast<std::size_t>(item.first >> shift) & (kBuckets - 1);
}

/// From how many items each chunk has in each bucket to where it puts the first of them.
void turn_into_starts(std::vector<Counts>& chunks) {
    std::uint32_t total = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
        for (Counts& counts : chunks) total += std::exchange(counts[bucket], total);
    }
}

}  // namespace

template <typename Key>
void radix_sort(std::vector<Keyed<Key>>& items, std::vector<Keyed<Key>>& room,
                std::uint64_t largest_key, const Execution& execution) {
    room.resize(items.size());
    std::vector<Counts> chunks(chunk_count(items.size(), kItemsPerChunk));
    for (unsigned shift = 0; shift < 8 * sizeof(Key) && (largest_key >> shift) != 0;
         shift += kBits) {
        parallel_for(execution, items.size(), kItemsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                         Counts& counts = chunks[chunk];
                         counts.fill(0);
                         for (std::size_t i = begin; i < end; ++i)
                             ++counts[bucket_of(items[i], shift)];
                     });
        turn_into_starts(chunks);
        parallel_for(execution, items.size(), kItemsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                         Counts& next = chunks[chunk];
                         for (std::size_t i = begin; i < end; ++i)
                             room[next[bucket_of(items[i], shift)]++] = items[i];
                     });
        items.swap(room);
    }
}

template void radix_sort(std::vector<Keyed<std::uint32_t>>&, std::vector<Keyed<std::uint32_t>>&,
                         std::uint64_t, const Execution&);
template void radix_sort(std::vector<Keyed<std::uint64_t>>&, std::vector<Keyed<std::uint64_t>>&,
                         std::uint64_t, const Execution&);

}  // namespace lpf
