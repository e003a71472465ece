#include "core/base/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stop_token>

#include "core/base/error.h"
#include "core/base/random.h"

namespace lpf {
namespace {

template <typename Key>
std::vector<Keyed<Key>> random_items(std::size_t n, std::uint64_t below) {
    Random random(n, below);
    std::vector<Keyed<Key>> items;
    for (std::uint32_t i = 0; i < n; ++i) {
        items.emplace_back(static_cast<Key>(random.below(below)), i);
    }
    return items;
}

template <typename Key>
void expect_stable_sort(std::size_t n, std::uint64_t below) {
    std::vector<Keyed<Key>> expected = random_items<Key>(n, below);
    std::ranges::stable_sort(expected, {}, &Keyed<Key>::first);
    for (const int threads : {1, 2, 5}) {
        std::vector<Keyed<Key>> items = random_items<Key>(n, below);
        std::vector<Keyed<Key>> room;
        radix_sort(items, room, below, {.threads = threads});
        EXPECT_EQ(items, expected)
            << n << " items below " << below << ", " << threads << " threads";
    }
}

TEST(RadixSort, SortsStablyForAnyNumberOfThreads) {
    for (const std::size_t n : {0U, 1U, 2U, 1000U, 200'000U}) {
        for (const std::uint64_t below : {1ULL, 2ULL, 2048ULL, 2049ULL, 1ULL << 32U}) {
            expect_stable_sort<std::uint32_t>(n, below);
        }
        expect_stable_sort<std::uint64_t>(n, 1ULL << 52U);
    }
}

TEST(RadixSort, CanBeCancelled) {
    std::stop_source source;
    source.request_stop();
    std::vector<Keyed<std::uint32_t>> items = random_items<std::uint32_t>(100, 50);
    std::vector<Keyed<std::uint32_t>> room;
    EXPECT_THROW(radix_sort(items, room, 50, {.stop = source.get_token()}), Error);
}

}  // namespace
}  // namespace lpf
