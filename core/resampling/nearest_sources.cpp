#include "core/resampling/nearest_sources.h"

#include <optional>
#include <utility>

#include "core/shape/extent.h"
#include "core/shape/point_grid.h"
#include "core/shape/spatial_index.h"

namespace lpf {
namespace {

constexpr std::size_t kQueriesPerChunk = 4096;
constexpr double kPointsOfCell = 2.0;
constexpr int kMostDoublings = 4;

/// The nearest point within a few cells, in balls that grow until one holds a point.
std::optional<std::uint32_t> nearest_within(const PointGrid& grid, const Eigen::Vector3d& at,
                                            double cell, NearPoints& near) {
    for (int i = 0; i <= kMostDoublings; ++i, cell *= 2) {
        grid.gather(at, cell, 1.0F, near);
        std::pair<double, std::uint32_t> nearest(0.0, 0);
        for (std::size_t k = 0; k < near.size; ++k) {
            const double squared = (grid.point(near.index[k]) - at).squaredNorm();
            if (k == 0 || squared < nearest.first) nearest = {squared, near.index[k]};
        }
        if (near.size > 0) return grid.order()[nearest.second];
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::uint32_t> nearest_sources(const Points& cloud, const Points& points,
                                           const Execution& execution) {
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<std::uint32_t> source(n);
    std::vector<std::vector<std::uint32_t>> far_off(chunk_count(n, kQueriesPerChunk));
    {
        double cell = cell_of_some_points(cloud, kPointsOfCell, execution);
        if (!(cell > 0)) {
            const double extent = bounding_box(cloud, execution).sizes().maxCoeff();
            cell = extent > 0 ? extent : 1.0;
        }
        const PointGrid grid(cloud, cell, execution);
        parallel_for(execution, "attributes", "points", n, kQueriesPerChunk,
                     [&](std::size_t begin, std::size_t end, std::size_t chunk) {
                         NearPoints near;
                         for (std::size_t i = begin; i < end; ++i) {
                             const auto found = nearest_within(
                                 grid, points.col(static_cast<Eigen::Index>(i)), cell, near);
                             source[i] = found.value_or(0);
                             if (!found) far_off[chunk].push_back(static_cast<std::uint32_t>(i));
                         }
                     });
    }
    // Balls about points far off the cloud may hold all of it: those ask a tree.
    std::optional<SpatialIndex> tree;
    for (const auto& of_chunk : far_off) {
        for (const std::uint32_t i : of_chunk) {
            if (!tree) tree.emplace(cloud, execution);
            source[i] = tree->nearest(points.col(static_cast<Eigen::Index>(i)), 1)[0].index;
        }
    }
    return source;
}

}  // namespace lpf
