#include "server/shapes/examination.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/field_set.h"
#include "core/shape/extent.h"
#include "core/shape/outliers.h"
#include "core/shape/spatial_index.h"

namespace lpf::server {
namespace {

constexpr std::size_t kBoxes = 6;
constexpr std::size_t kSketch = 1U << 16U;  // points that the size of a box is guessed from
constexpr std::size_t kCountedPoints = 2000;
constexpr double kOutlierDeviations = 6.0;  // as in a job
constexpr auto kGone = std::numeric_limits<std::uint32_t>::max();

double distance_in_box(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

/// A cube around a point that holds about `share` of all points.
struct Box {
    Eigen::Vector3d centre;
    double half = 0;

    Box(const Points& points, std::uint64_t number, double share) {
        Random random(static_cast<std::uint64_t>(points.cols()), number);
        const auto draw = [&] {
            return points.col(
                static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(points.cols()))));
        };
        centre = draw();
        std::vector<double> distances(kSketch);
        for (double& distance : distances) distance = distance_in_box(draw(), centre);
        const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(kSketch));
        std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
        half = distances[static_cast<std::size_t>(rank)];
    }
    [[nodiscard]] bool holds(const Eigen::Vector3d& point) const {
        return distance_in_box(point, centre) <= half;
    }
};

/// The points that are kept, and the triangles between them.
Shape only(const Shape& shape, const std::vector<std::uint32_t>& kept) {
    Shape part;
    part.cloud.points = selected(shape.cloud.points, kept);
    if (!shape.is_mesh()) return part;
    std::vector<std::uint32_t> number(shape.size(), kGone);
    for (std::uint32_t i = 0; i < kept.size(); ++i) number[kept[i]] = i;
    part.triangles.resize(3, shape.triangles.cols());
    Eigen::Index count = 0;
    for (Eigen::Index f = 0; f < shape.triangles.cols(); ++f) {
        const auto corner = [&](int c) { return number[shape.triangles(c, f)]; };
        if (corner(0) == kGone || corner(1) == kGone || corner(2) == kGone) continue;
        part.triangles.col(count++) << corner(0), corner(1), corner(2);
    }
    part.triangles.conservativeResize(3, count);
    return part;
}

std::vector<std::uint32_t> count_neighbours(const Points& points, double radius) {
    const SpatialIndex index(points);
    const auto n = static_cast<std::size_t>(points.cols());
    std::vector<std::uint32_t> counts;
    std::vector<SpatialIndex::Neighbour> found;
    // A radius that holds thousands needs no more than a few points to show it.
    constexpr std::size_t kMostFound = 20'000'000;
    std::size_t work = 0;
    Random random(n, 0xc0);
    for (std::size_t i = 0; i < std::min(n, kCountedPoints) && work < kMostFound; ++i) {
        const auto chosen = static_cast<Eigen::Index>(n <= kCountedPoints ? i : random.below(n));
        index.within(points.col(chosen), radius, found);
        counts.push_back(static_cast<std::uint32_t>(found.size() - 1));  // itself is none
        work += found.size();
    }
    std::ranges::sort(counts);
    return counts;
}

double number_of(const std::vector<std::uint8_t>& flags) {
    return static_cast<double>(std::ranges::count(flags, 1));
}

}  // namespace

ShapePart part_of_shape(const Shape& shape, std::size_t most) {
    const std::size_t n = shape.size();
    if (n <= most) return {{{shape.cloud.points, {}}, shape.triangles}, 1.0};
    const double share = static_cast<double>(most) / static_cast<double>(n * kBoxes);
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < kBoxes; ++i) boxes.emplace_back(shape.cloud.points, i, share);
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d point = shape.cloud.points.col(static_cast<Eigen::Index>(i));
        if (std::ranges::any_of(boxes, [&](const Box& box) { return box.holds(point); }))
            kept.push_back(static_cast<std::uint32_t>(i));
    }
    return {only(shape, kept), static_cast<double>(kept.size()) / static_cast<double>(n)};
}

ShapePart part_of_points(const PointSource& source, const Sketch& sketch, std::size_t most,
                         const Execution& execution) {
    const Partition partition(sketch, static_cast<double>(most) / kBoxes);
    const Excerpt excerpt = make_excerpt(source, partition, kBoxes, 0.0, execution);
    ShapePart part;
    source.read(excerpt.points, part.shape.cloud.points);
    source.let_go();
    part.share = static_cast<double>(excerpt.points.size()) / static_cast<double>(sketch.of);
    return part;
}

Measurements measure_part(const ShapePart& part, std::size_t points, double diagonal,
                          const Execution& execution) {
    Measurements measured = measure(part.shape.cloud.points, execution);
    if (part.is_whole()) return measured;
    measured.points = points;
    measured.diagonal = diagonal;
    return measured;
}

Findings examine(const ShapePart& part, const ResolvedParameters& parameters,
                 const Execution& execution) {
    const Points& points = part.shape.cloud.points;
    Findings found;
    found.duplicates = number_of(find_duplicates(points)) / part.share;
    found.outliers = number_of(find_outliers(points, kOutlierDeviations, execution)) / part.share;
    found.neighbours = count_neighbours(points, parameters.analysis.radius);
    AnalysisParams params = parameters.analysis;
    if (params.probing == ProbingKind::NearestTriangle && !part.shape.is_mesh())
        params.probing = ProbingKind::NoiseAware;  // no face of the mesh lies within the part
    if (parameters.resample.denoise) {
        // Its LPFs lie on denoised points, not there yet: those of one radius are as many.
        params.noise = 0;
        params.adapt_radius = false;
    }
    const FieldSet fields(part.shape, params, execution);
    std::vector<double> targets(fields.size());
    fields.for_each_target("place", execution,
                           [&](std::size_t j, FieldSet::Worker& worker, std::size_t) {
                               targets[j] = static_cast<double>(worker.probe.target.size);
                           });
    double sum = 0;
    for (const double size : targets) sum += size;
    found.fields = static_cast<double>(fields.size()) / part.share;
    found.points_per_field = sum / std::max(1.0, static_cast<double>(fields.size()));
    found.probed_points = static_cast<double>(fields.grid().size()) / part.share;
    return found;
}

}  // namespace lpf::server
