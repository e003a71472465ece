#include "tests/support/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/parallel.h"

namespace lpf::test {
namespace {

std::size_t columns(const Points& points) { return static_cast<std::size_t>(points.cols()); }

std::vector<PiecePtr> pieces_of_dimension(const TestShape& shape, int dimension) {
    std::vector<PiecePtr> result;
    for (const PiecePtr& piece : shape.pieces) {
        if (piece->dimension() == dimension) result.push_back(piece);
    }
    return result;
}

}  // namespace

ErrorStats summarize(std::vector<double> distances) {
    ErrorStats stats{.count = distances.size()};
    if (distances.empty()) return stats;
    std::sort(distances.begin(), distances.end());
    const auto n = static_cast<double>(distances.size());
    stats.mean = std::accumulate(distances.begin(), distances.end(), 0.0) / n;
    const double squares =
        std::inner_product(distances.begin(), distances.end(), distances.begin(), 0.0);
    stats.rmse = std::sqrt(squares / n);
    stats.p95 = distances[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
    stats.max = distances.back();
    return stats;
}

std::vector<double> distances_of(const Points& points,
                                 const std::function<double(const Vector3d&)>& distance,
                                 int threads) {
    std::vector<double> distances(columns(points));
    parallel_for({.threads = threads}, distances.size(), 2048,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         distances[i] = distance(points.col(static_cast<Eigen::Index>(i)));
                     }
                 });
    return distances;
}

ErrorStats error_to_shape(const Points& points, const TestShape& shape,
                          const std::vector<std::uint8_t>& use) {
    const std::vector<double> all =
        distances_of(points, [&](const Vector3d& point) { return shape.distance(point); });
    if (use.empty()) return summarize(all);
    std::vector<double> chosen;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (use.at(i)) chosen.push_back(all[i]);
    }
    return summarize(std::move(chosen));
}

PartErrors error_by_part(const Points& points, const TestShape& shape, double edge_reach) {
    const auto to = [&](const std::vector<PiecePtr>& pieces) {
        return distances_of(points,
                            [&](const Vector3d& p) { return distance_to_pieces(pieces, p); });
    };
    const std::vector<double> surface = to(pieces_of_dimension(shape, 2));
    const std::vector<double> curve = to(pieces_of_dimension(shape, 1));
    const std::vector<double> edge = to(shape.edges);
    std::vector<double> all, on_surface, on_curve, near_edges;
    for (std::size_t i = 0; i < surface.size(); ++i) {
        all.push_back(std::min(surface[i], curve[i]));
        (surface[i] <= curve[i] ? on_surface : on_curve).push_back(all.back());
        if (edge[i] <= edge_reach) near_edges.push_back(all.back());
    }
    return {summarize(std::move(all)), summarize(std::move(on_surface)),
            summarize(std::move(on_curve)), summarize(std::move(near_edges))};
}

double coverage(const Points& reference, const Points& points) {
    const CloudDistance nearest(points);
    return summarize(distances_of(reference, nearest)).rmse;
}

ShapeCoverage coverage_of_shape(const TestShape& shape, const Points& points, std::size_t samples) {
    const CloudDistance nearest(points);
    const auto of = [&](const std::vector<PiecePtr>& pieces) {
        if (pieces.empty()) return std::numeric_limits<double>::quiet_NaN();
        return summarize(distances_of(sample_pieces(pieces, samples, 7), nearest)).rmse;
    };
    std::vector<double> to_ends;
    for (const Vector3d& end : shape.ends) to_ends.push_back(nearest(end));
    return {of(pieces_of_dimension(shape, 2)), of(pieces_of_dimension(shape, 1)), of(shape.borders),
            to_ends.empty() ? std::numeric_limits<double>::quiet_NaN() : summarize(to_ends).rmse,
            of(shape.edges)};
}

NeighbourStats nearest_neighbour_stats(const Points& points) {
    NeighbourStats stats;
    const CloudDistance nearest(points);
    stats.distances.resize(columns(points));
    parallel_for({.threads = 2}, stats.distances.size(), 2048,
                 [&](std::size_t begin, std::size_t end, std::size_t) {
                     for (std::size_t i = begin; i < end; ++i) {
                         stats.distances[i] =
                             nearest.to_others(points.col(static_cast<Eigen::Index>(i)),
                                               static_cast<std::uint32_t>(i));
                     }
                 });
    const ErrorStats all = summarize(stats.distances);
    if (all.count == 0) return stats;
    stats.mean = all.mean;
    stats.deviation = std::sqrt(std::max(0.0, all.rmse * all.rmse - all.mean * all.mean));
    stats.min = *std::min_element(stats.distances.begin(), stats.distances.end());
    stats.max = all.max;
    return stats;
}

ErrorStats displacement(const Points& before, const Points& after) {
    std::vector<double> moves;
    for (Eigen::Index i = 0; i < before.cols(); ++i) {
        moves.push_back((after.col(i) - before.col(i)).norm());
    }
    return summarize(std::move(moves));
}

double diagonal_of(const Points& points) {
    if (points.cols() == 0) return 0.0;
    return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

}  // namespace lpf::test
