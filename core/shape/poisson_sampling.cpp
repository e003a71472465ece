#include "core/shape/poisson_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/base/random.h"

namespace lpf {
namespace {

/// A pseudo-random permutation of [0, n) that needs no memory: invertible mixing of the smallest
/// power of two >= n, walking on while the image lies outside.
class Permutation {
public:
    Permutation(std::uint64_t n, std::uint64_t random_seed) : n_(n), mask_(std::bit_ceil(n) - 1) {
        shift_ = std::max(1, static_cast<int>(std::bit_width(mask_)) / 2);
        Random random(random_seed);
        for (Round& round : rounds_) round = {random.bits() | 1, random.bits()};
    }

    [[nodiscard]] std::uint64_t operator[](std::uint64_t i) const {
        do {
            for (const Round& round : rounds_) {
                i = (i * round.factor + round.offset) & mask_;
                i ^= i >> shift_;
            }
        } while (i >= n_);
        return i;
    }

private:
    struct Round {
        std::uint64_t factor;  // odd, hence invertible
        std::uint64_t offset;
    };

    std::uint64_t n_;
    std::uint64_t mask_;
    int shift_;
    Round rounds_[4];
};

using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

/// The chosen points in a hash grid. Its cells are at least two spacings wide, so that the ball
/// around a point meets at most eight of them. Cells with equal hashes share a list, which costs
/// time but changes nothing: distances decide.
class DiskSet {
public:
    DiskSet(const Points& points, double spacing)
        : squared_spacing_(spacing * spacing), slots_(1U << 10U, kEmpty) {
        low_ = points.rowwise().minCoeff();
        const double extent = (points.rowwise().maxCoeff() - low_).maxCoeff();
        cell_size_ = std::max(2.001 * spacing, extent * 0x1p-30);
    }

    /// Chooses the point unless a chosen one is nearer than the spacing.
    bool insert(const Eigen::Vector3d& point) {
        const Eigen::Vector3d position = (point - low_) / cell_size_;
        const Eigen::Vector3d floor = position.array().floor();
        const Cell cell = floor.cast<std::int64_t>();
        Cell towards;  // to the nearer neighbour along each axis
        for (int c = 0; c < 3; ++c) towards[c] = position[c] - floor[c] < 0.5 ? -1 : 1;
        for (int corner = 0; corner < 8; ++corner) {
            const Cell step(corner & 1, (corner >> 1) & 1, corner >> 2);
            if (has_near(hash(cell + step.cwiseProduct(towards)), point)) return false;
        }
        add(hash(cell), point);
        return true;
    }

private:
    static constexpr std::uint32_t kEmpty = 0xffffffff;

    struct Disk {
        Eigen::Vector3d point;
        std::uint64_t key;
        std::uint32_t next;  // disk of the same key
    };

    static std::uint64_t hash(const Cell& cell) {
        std::uint64_t key = 0;
        for (int c = 0; c < 3; ++c) {
            key = (key ^ static_cast<std::uint64_t>(cell[c])) * 0x9e3779b97f4a7c15ULL;
            key ^= key >> 32U;
        }
        return key;
    }

    /// The slot that holds the key, or the empty one where it belongs.
    [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
        std::size_t slot = key & (slots_.size() - 1);
        while (slots_[slot] != kEmpty && disks_[slots_[slot]].key != key) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        return slot;
    }

    [[nodiscard]] bool has_near(std::uint64_t key, const Eigen::Vector3d& point) const {
        for (std::uint32_t i = slots_[slot_of(key)]; i != kEmpty; i = disks_[i].next) {
            if ((disks_[i].point - point).squaredNorm() < squared_spacing_) return true;
        }
        return false;
    }

    void add(std::uint64_t key, const Eigen::Vector3d& point) {
        if (2 * used_slots_ >= slots_.size()) grow();
        std::uint32_t& head = slots_[slot_of(key)];
        used_slots_ += head == kEmpty;
        disks_.push_back({point, key, head});
        head = static_cast<std::uint32_t>(disks_.size() - 1);
    }

    void grow() {
        const std::vector<std::uint32_t> old = std::move(slots_);
        slots_.assign(2 * old.size(), kEmpty);
        for (const std::uint32_t head : old) {
            if (head != kEmpty) slots_[slot_of(disks_[head].key)] = head;
        }
    }

    double squared_spacing_;
    Eigen::Vector3d low_;
    double cell_size_;
    std::vector<Disk> disks_;
    std::vector<std::uint32_t> slots_;  // open addressing; first disk of a key
    std::size_t used_slots_ = 0;
};

double area_of(const Points& vertices, const Triangles& triangles, Eigen::Index f) {
    const Eigen::Vector3d corner = vertices.col(triangles(0, f));
    const Eigen::Vector3d a = vertices.col(triangles(1, f)) - corner;
    const Eigen::Vector3d b = vertices.col(triangles(2, f)) - corner;
    return a.cross(b).norm() / 2;
}

/// How many samples each triangle gets: the running total of the expected numbers, rounded at a
/// random offset, so that every total is right to within one.
std::vector<std::size_t> share_out(const std::vector<double>& areas, double per_area,
                                   std::uint64_t random_seed) {
    std::vector<std::size_t> counts(areas.size(), 0);
    double expected = Random(random_seed).uniform();
    std::size_t given = 0;
    for (std::size_t f = 0; f < areas.size(); ++f) {
        expected += areas[f] * per_area;
        const auto total = static_cast<std::size_t>(expected);
        counts[f] = total - given;
        given = total;
    }
    const auto largest = std::max_element(areas.begin(), areas.end());
    if (given == 0 && largest != areas.end() && *largest > 0) {
        counts[static_cast<std::size_t>(largest - areas.begin())] = 1;
    }
    return counts;
}

}  // namespace

std::vector<std::uint32_t> poisson_disk_subset(const Points& points, double spacing,
                                               std::uint64_t random_seed,
                                               const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<std::uint32_t> chosen;
    if (n == 0) return chosen;
    if (!(spacing > 0)) {
        chosen.resize(n);
        std::iota(chosen.begin(), chosen.end(), 0U);
        return chosen;
    }
    DiskSet disks(points, spacing);
    const Permutation permutation(n, random_seed);
    // Each choice depends on those before: one thread, in chunks for cancellation and progress.
    Execution sequential = execution;
    sequential.threads = 1;
    parallel_for(sequential, "seeds", "points", n, 1U << 16U,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         const auto index = static_cast<std::uint32_t>(permutation[i]);
                         if (disks.insert(points.col(index))) chosen.push_back(index);
                     }
                 });
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

Points sample_triangles(const Points& vertices, const Triangles& triangles, double per_area,
                        std::uint64_t random_seed) {
    std::vector<double> areas(static_cast<std::size_t>(triangles.cols()));
    for (std::size_t f = 0; f < areas.size(); ++f) {
        areas[f] = area_of(vertices, triangles, static_cast<Eigen::Index>(f));
    }
    const std::vector<std::size_t> counts = share_out(areas, per_area, random_seed);
    Points samples(3, std::accumulate(counts.begin(), counts.end(), Eigen::Index{0}));
    Eigen::Index next = 0;
    for (std::size_t f = 0; f < counts.size(); ++f) {
        Random random(random_seed, f + 1);
        const auto corners = triangles.col(static_cast<Eigen::Index>(f));
        for (std::size_t i = 0; i < counts[f]; ++i) {
            // The square root makes it uniform by area (Osada et al. 2002).
            const double root = std::sqrt(random.uniform());
            const double share = random.uniform();
            samples.col(next++) = (1 - root) * vertices.col(corners[0]) +
                                  root * (1 - share) * vertices.col(corners[1]) +
                                  root * share * vertices.col(corners[2]);
        }
    }
    return samples;
}

}  // namespace lpf
