#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/shape/shape.h"
#include "tests/support/shapes.h"

namespace lpf::test {

/// What a set of distances looks like. All zero for an empty set.
struct ErrorStats {
    std::size_t count = 0;
    double mean = 0.0;
    double rmse = 0.0;
    double p95 = 0.0;
    double max = 0.0;
};

[[nodiscard]] ErrorStats summarize(std::vector<double> distances);

/// Distances of all points by `distance`, on `threads` threads.
[[nodiscard]] std::vector<double> distances_of(
    const Points& points, const std::function<double(const Vector3d&)>& distance, int threads = 2);

/// From points to the exact shape. @param use points to count (1) or not (0), or empty: all
[[nodiscard]] ErrorStats error_to_shape(const Points& points, const TestShape& shape,
                                        const std::vector<std::uint8_t>& use = {});

/// Errors of the points by what they are nearest to; near_edges counts some of the others again.
struct PartErrors {
    ErrorStats all;
    ErrorStats surface;     ///< points nearest to a surface
    ErrorStats curve;       ///< points nearest to a curve
    ErrorStats near_edges;  ///< points at most `edge_reach` from a sharp edge
};
[[nodiscard]] PartErrors error_by_part(const Points& points, const TestShape& shape,
                                       double edge_reach);

/// RMS distance from `reference` to the nearest of `points`: large where a result has holes.
[[nodiscard]] double coverage(const Points& reference, const Points& points);

/// coverage() of the parts of a shape, each by its own samples; NaN where the shape has no such
/// part.
struct ShapeCoverage {
    double surface;
    double curve;
    double border;
    double end;
    double edge;
};
[[nodiscard]] ShapeCoverage coverage_of_shape(const TestShape& shape, const Points& points,
                                              std::size_t samples = 20000);

/// Distances from each point to its nearest other point.
struct NeighbourStats {
    double mean = 0.0;
    double deviation = 0.0;  ///< standard deviation
    double min = 0.0;
    double max = 0.0;
    std::vector<double> distances = {};  ///< of every point, for a histogram
};
[[nodiscard]] NeighbourStats nearest_neighbour_stats(const Points& points);

/// Displacements row by row. @pre as many points in `after` as in `before`
[[nodiscard]] ErrorStats displacement(const Points& before, const Points& after);

[[nodiscard]] double diagonal_of(const Points& points);

/// Nearest distance to a set of points. Exact.
class CloudDistance {
public:
    explicit CloudDistance(const Points& points);
    [[nodiscard]] double operator()(const Vector3d& query) const;
    /// As above, with one point of the set left out.
    [[nodiscard]] double to_others(const Vector3d& query, std::uint32_t left_out) const;

private:
    Points points_;
    Bvh bvh_;
};

/// Nearest distance to the triangles of a mesh. Exact (to rounding): a tree prunes, no sampling.
class MeshDistance {
public:
    MeshDistance(const Points& vertices, const Triangles& triangles);
    [[nodiscard]] double operator()(const Vector3d& query) const;

private:
    Points vertices_;
    Triangles triangles_;
    Bvh bvh_;
};

/// Squared distance to a triangle, also to one without area.
[[nodiscard]] double squared_distance_to_triangle(const Vector3d& query, const Vector3d& a,
                                                  const Vector3d& b, const Vector3d& c);

}  // namespace lpf::test
