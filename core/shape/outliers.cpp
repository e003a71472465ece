#include "core/shape/outliers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include "core/base/radix_sort.h"
#include "core/shape/quantile.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr std::size_t kNeighbours = 8;
constexpr std::size_t kFewestPoints = 32;  // below, a median of all says nothing

/// Least robust standard deviation of the logarithm: on a regular lattice the deviation is 0, and
/// its corners, twice as far from their neighbours as the rest, are no outliers.
constexpr double kLeastDeviation = 0.2;

/// Mean distance of each point to its nearest other points.
std::vector<double> mean_distances(const Points& points, const Execution& execution) {
    const SpatialIndex index(points, execution);
    std::vector<double> distances(static_cast<std::size_t>(points.cols()));
    parallel_for(execution, "outliers", "points", distances.size(), 4096,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     std::vector<SpatialIndex::Neighbour> found;
                     for (std::size_t i = begin; i < end; ++i) {
                         const auto column = static_cast<Eigen::Index>(i);
                         // The nearest of all is the point itself or one in the same place.
                         index.nearest(points.col(column), kNeighbours + 1, found);
                         double sum = 0;
                         for (const auto& neighbour : found) {
                             sum += std::sqrt(neighbour.squared_distance);
                         }
                         distances[i] = sum / static_cast<double>(kNeighbours);
                     }
                 });
    return distances;
}

/// The distance above which a point is isolated.
double limit_for(const std::vector<double>& distances, double deviations,
                 const Execution& execution) {
    std::vector<double> logarithms;
    for (const double distance : distances) {
        if (distance > 0) logarithms.push_back(std::log(distance));  // 0: a heap of duplicates
    }
    if (logarithms.empty()) return 0;
    throw_if_cancelled(execution);
    const double centre = median(logarithms);
    throw_if_cancelled(execution);
    for (double& value : logarithms) value = std::abs(value - centre);
    const double deviation = std::max(kLeastDeviation, 1.4826 * median(logarithms));
    return std::exp(centre + deviations * deviation);
}

/// Equal positions have equal hashes, so each bucket of hashes is searched for itself.
constexpr std::size_t kBuckets = 1024;
constexpr std::uint64_t kHashesPerBucket = (~std::uint64_t{0} / kBuckets) + 1;

std::size_t bucket_of(std::uint64_t hash) { return hash / kHashesPerBucket; }

struct Key {
    std::uint64_t hash;
    std::uint32_t index;
};

std::uint64_t hash_position(const Points& points, std::uint32_t index) {
    std::uint64_t hash = 0;
    for (int c = 0; c < 3; ++c) {
        const double coordinate = points(c, index) + 0.0;  // -0.0 becomes 0.0
        hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15ULL;
        hash ^= hash >> 29U;
    }
    return hash;
}

/// Marks the repeats in a run of equal hashes. Positions are compared: hashes may meet by accident.
void mark_repeats(const Points& points, std::span<Key> run, std::vector<std::uint8_t>& repeated) {
    const auto place = [&](const Key& key) {
        return std::array{points(0, key.index), points(1, key.index), points(2, key.index)};
    };
    const auto first = place(run.front());
    const bool one_place =
        std::all_of(run.begin(), run.end(), [&](const Key& key) { return place(key) == first; });
    if (!one_place) {
        std::stable_sort(run.begin(), run.end(),
                         [&](const Key& a, const Key& b) { return place(a) < place(b); });
    }
    for (std::size_t i = 1; i < run.size(); ++i) {
        if (one_place || place(run[i]) == place(run[i - 1])) repeated[run[i].index] = 1;
    }
}

/// Sorts a bucket, unless it is a heap of one position, and marks its repeats.
void mark_bucket(const Points& points, std::span<Key> keys, std::vector<std::uint8_t>& repeated) {
    const auto by_hash = [](const Key& a, const Key& b) {
        return a.hash != b.hash ? a.hash < b.hash : a.index < b.index;
    };
    if (!std::is_sorted(keys.begin(), keys.end(), by_hash)) {
        std::sort(keys.begin(), keys.end(), by_hash);
    }
    for (std::size_t begin = 0; begin < keys.size();) {
        std::size_t end = begin + 1;
        while (end < keys.size() && keys[end].hash == keys[begin].hash) ++end;
        if (end - begin > 1) mark_repeats(points, keys.subspan(begin, end - begin), repeated);
        begin = end;
    }
}

/// The points by the bucket of their position, in their order within a bucket. They are hashed
/// twice: to keep the hashes until then would take eight bytes more for each.
std::vector<Key> into_buckets(const Points& points, const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<Keyed<std::uint32_t>> sorted(n);
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         const auto point = static_cast<std::uint32_t>(i);
                         const std::size_t bucket = bucket_of(hash_position(points, point));
                         sorted[i] = {static_cast<std::uint32_t>(bucket), point};
                     }
                 });
    {
        std::vector<Keyed<std::uint32_t>> room;
        radix_sort(sorted, room, kBuckets - 1, execution);
    }
    std::vector<Key> keys(n);
    parallel_for(execution, n, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         const std::uint32_t point = sorted[i].second;
                         keys[i] = {hash_position(points, point), point};
                     }
                 });
    return keys;
}

}  // namespace

std::vector<std::uint8_t> find_outliers(const Points& points, double deviations,
                                        const Execution& execution) {
    std::vector<std::uint8_t> isolated(static_cast<std::size_t>(points.cols()), 0);
    if (isolated.size() < kFewestPoints) return isolated;
    const std::vector<double> distances = mean_distances(points, execution);
    const double limit = limit_for(distances, deviations, execution);
    for (std::size_t i = 0; i < isolated.size(); ++i) isolated[i] = distances[i] > limit;
    return isolated;
}

std::vector<std::uint8_t> find_duplicates(const Points& points, const Execution& execution) {
    std::vector<std::uint8_t> repeated(static_cast<std::size_t>(points.cols()), 0);
    std::vector<Key> keys = into_buckets(points, execution);
    parallel_for(execution, "duplicates", "buckets", kBuckets, 1,
                 [&](std::size_t bucket, std::size_t, std::size_t) {
                     const auto of_bucket = std::ranges::equal_range(
                         keys, bucket, {}, [](const Key& key) { return bucket_of(key.hash); });
                     mark_bucket(points, of_bucket, repeated);
                 });
    return repeated;
}

}  // namespace lpf
