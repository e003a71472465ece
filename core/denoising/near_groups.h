#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "core/base/parallel.h"
#include "core/shape/point_grid.h"

namespace lpf {

/// Points that follow each other in an order and lie close together.
struct NearGroup {
    std::size_t begin;
    std::size_t end;
    Eigen::Vector3d centre;
    double radius;  ///< of a ball about the centre that holds them [input length]
};

/// Groups for points in an order in which neighbours in space mostly follow each other: what is
/// around a group is searched for once, not for every point.
/// @param at   the position of point i [input length]
/// @param side of a box that no group is larger than [input length]
template <typename At>
[[nodiscard]] std::vector<NearGroup> near_groups(std::size_t points, double side, const At& at,
                                                 const Execution& execution) {
    std::vector<std::vector<NearGroup>> of_chunks(chunk_count(points, kPointsPerChunk));
    parallel_for(execution, points, kPointsPerChunk,
                 [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                     Eigen::AlignedBox3d box;
                     std::size_t first = begin;
                     const auto close = [&](std::size_t last) {
                         of_chunks[chunk].push_back(
                             {first, last, box.center(), 0.5 * box.diagonal().norm()});
                     };
                     for (std::size_t i = begin; i < end; ++i) {
                         const Eigen::Vector3d place = at(i);
                         const Eigen::AlignedBox3d larger = box.merged(Eigen::AlignedBox3d(place));
                         if (i > first && (larger.sizes().array() > side).any()) {
                             close(i);
                             first = i;
                             box = Eigen::AlignedBox3d(place);
                         } else {
                             box = larger;
                         }
                     }
                     close(end);
                 });
    std::vector<NearGroup> groups;
    for (const auto& part : of_chunks) groups.insert(groups.end(), part.begin(), part.end());
    return groups;
}

/// All points of a grid within `reach` units of some point of a group, and a few more; relative to
/// the group's centre. @param unit of the results [input length]
inline void gather_around(const PointGrid& grid, const NearGroup& group, double unit, float reach,
                          NearPoints& near) {
    grid.gather(group.centre, unit, reach + static_cast<float>(group.radius / unit), near);
}

}  // namespace lpf
