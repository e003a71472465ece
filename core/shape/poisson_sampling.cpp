#include "core/shape/poisson_sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "core/shape/coloured_cells.h"

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

/// Points are chosen cell by cell, each cell in a random order of its own: what is near in space is
/// near in memory then. Sides of cells [spacings].
constexpr double kCellSide = 8.0;
constexpr std::size_t kCellsPerChunk = 4;

/// The largest float below 1: a point just at the spacing may stay.
constexpr float kInside = 0x1.fffffep-1F;

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

std::vector<std::uint32_t> poisson_disk_subset(const PointGrid& grid,
                                               std::span<const std::uint32_t> places,
                                               double spacing, std::uint64_t random_seed,
                                               const Execution& execution) {
    std::vector<std::uint32_t> chosen;
    if (places.empty()) return chosen;
    if (!(spacing > 0)) {
        chosen.resize(places.size());
        std::iota(chosen.begin(), chosen.end(), 0U);
        return chosen;
    }
    std::vector<std::uint8_t> is_covered(grid.size(), 0);
    std::vector<std::uint8_t> is_chosen(places.size(), 0);
    const auto choose = [&](std::uint32_t k, NearPoints& disk) {
        if (is_covered[places[k]]) return;
        is_chosen[k] = 1;
        grid.gather(grid.point(places[k]), spacing, kInside, disk);
        is_covered[places[k]] = 1;
        for (std::size_t p = 0; p < disk.size; ++p) is_covered[disk.index[p]] = 1;
    };
    const ColouredCells cells(grid, places, kCellSide * spacing, execution);
    for (std::size_t colour = 0; colour < ColouredCells::kColours; ++colour) {
        const std::vector<ColouredCells::Cell>& of_colour = cells.of_colour(colour);
        parallel_for(step_of(execution, colour, ColouredCells::kColours), "seeds", "cells",
                     of_colour.size(), kCellsPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t) {
                         NearPoints disk;
                         for (std::size_t c = begin; c < end; ++c) {
                             const auto [key, first, last] = of_colour[c];
                             const Permutation order(last - first, random_seed + key);
                             for (std::uint32_t i = 0; i < last - first; ++i) {
                                 choose(cells.member(first + order[i]), disk);
                             }
                         }
                     });
    }
    for (std::uint32_t k = 0; k < places.size(); ++k) {
        if (is_chosen[k]) chosen.push_back(k);
    }
    return chosen;
}

std::vector<std::uint32_t> poisson_disk_subset(const Points& points, double spacing,
                                               std::uint64_t random_seed,
                                               const Execution& execution) {
    const PointGrid grid(points, spacing > 0 ? spacing : 1.0, execution);
    return poisson_disk_subset(grid, grid.places(), spacing, random_seed, execution);
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
