#include "core/shape/tiling.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace lpf {
namespace {

constexpr std::size_t kPointsOfSketch = 1U << 18U;

/// Points that are in memory at a time while a cloud is passed over.
constexpr std::size_t kPointsOfRun = 1U << 13U;

/// The cloud is passed over in so many parts, whatever the number of threads.
constexpr std::size_t kPartsOfPass = 64;

/// Calls visit(part, index, place) for each finite point; the parts run in parallel.
template <typename Visit>
void for_each_point(const PointSource& source, const Execution& execution, const Visit& visit) {
    const std::size_t n = source.size();
    const std::size_t size = std::max(kPointsOfRun, chunk_count(n, kPartsOfPass));
    parallel_for(execution, n, size, [&](std::size_t begin, std::size_t end, std::size_t part) {
        Points run;
        for (std::size_t first = begin; first < end; first += kPointsOfRun) {
            throw_if_cancelled(execution);
            run.resize(3, static_cast<Eigen::Index>(std::min(kPointsOfRun, end - first)));
            source.read(first, run);
            for (Eigen::Index i = 0; i < run.cols(); ++i) {
                const Eigen::Vector3d place = run.col(i);
                if (place.allFinite()) visit(part, first + static_cast<std::size_t>(i), place);
            }
        }
        source.let_go();
    });
}

std::vector<std::uint32_t> joined(const std::vector<std::vector<std::uint32_t>>& parts) {
    std::vector<std::uint32_t> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

struct Cut {
    int axis = 0;
    double place = 0.0;
};

/// At the median of the longest side; nothing where all points coincide. Points lie on both sides.
std::optional<Cut> find_cut(std::span<Eigen::Vector3d> points) {
    Eigen::Vector3d low = points.front();
    Eigen::Vector3d high = low;
    for (const Eigen::Vector3d& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    Cut cut;
    if (!((high - low).maxCoeff(&cut.axis) > 0)) return std::nullopt;
    const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
    std::ranges::nth_element(points, middle, {}, [&](const auto& p) { return p[cut.axis]; });
    cut.place = (*middle)[cut.axis];
    // Half of the points and more may lie at the lower end: the next ones are beyond the cut then.
    if (cut.place > low[cut.axis]) return cut;
    cut.place = high[cut.axis];
    for (const Eigen::Vector3d& p : points) {
        if (p[cut.axis] > low[cut.axis]) cut.place = std::min(cut.place, p[cut.axis]);
    }
    return cut;
}

}  // namespace

Sketch make_sketch(const PointSource& source, const Execution& execution) {
    struct Part {
        std::vector<Eigen::Vector3d> points;
        Eigen::Vector3d low, high;
        std::size_t finite = 0;
    };
    const std::size_t stride = std::max<std::size_t>(1, source.size() / kPointsOfSketch);
    std::vector<Part> parts(kPartsOfPass);
    for_each_point(source, execution,
                   [&](std::size_t at, std::size_t index, const Eigen::Vector3d& place) {
                       Part& part = parts[at];
                       if (part.finite++ == 0) part.low = part.high = place;
                       part.low = part.low.cwiseMin(place);
                       part.high = part.high.cwiseMax(place);
                       if (index % stride == 0) part.points.push_back(place);
                   });
    Sketch sketch;
    for (const Part& part : parts) {
        if (part.finite == 0) continue;
        const bool first = sketch.of == 0;
        sketch.low = first ? part.low : sketch.low.cwiseMin(part.low);
        sketch.high = first ? part.high : sketch.high.cwiseMax(part.high);
        sketch.of += part.finite;
        sketch.points.insert(sketch.points.end(), part.points.begin(), part.points.end());
    }
    return sketch;
}

Partition::Partition(const Sketch& sketch, double most) : low_(sketch.low), high_(sketch.high) {
    std::vector<Eigen::Vector3d> points = sketch.points;
    const double share = static_cast<double>(points.size()) /
                         static_cast<double>(std::max<std::size_t>(1, sketch.of));
    build(points, std::max(1.0, most * share), Box{});
}

std::uint32_t Partition::build(std::span<Eigen::Vector3d> points, double most, const Box& box) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    const auto cut = static_cast<double>(points.size()) > most ? find_cut(points) : std::nullopt;
    if (!cut) {
        nodes_[at].low = static_cast<std::uint32_t>(boxes_.size());
        boxes_.push_back(box);
        return at;
    }
    const auto beyond = std::ranges::partition(
        points, [&](const Eigen::Vector3d& p) { return p[cut->axis] < cut->place; });
    const std::size_t below = points.size() - beyond.size();
    Box low = box;
    Box high = box;
    low.high[cut->axis] = high.low[cut->axis] = cut->place;
    const std::uint32_t first = build(points.first(below), most, low);
    const std::uint32_t second = build(points.subspan(below), most, high);
    nodes_[at] = {cut->axis, cut->place, first, second};
    return at;
}

Partition::Nearness::Nearness(const Partition& partition, const std::vector<std::uint32_t>& boxes,
                              double distance)
    : partition_(partition),
      leads_to_(partition.nodes_above(boxes)),
      distance_(distance),
      cells_(static_cast<std::size_t>(kCells) * kCells * kCells) {
    const Eigen::Array3d cell = (partition.high_ - partition.low_).array() / kCells;
    cells_per_length_ = cell.inverse();
    // Rounding is far less than what this is more than half of a diagonal.
    const double around = distance + 0.51 * cell.matrix().norm();
    std::size_t at = 0;
    for (int k = 0; k < kCells; ++k) {
        for (int j = 0; j < kCells; ++j) {
            for (int i = 0; i < kCells; ++i) {
                const Eigen::Array3d middle = Eigen::Array3d(i + 0.5, j + 0.5, k + 0.5) * cell;
                cells_[at++] = is_near(partition.low_ + middle.matrix(), around);
            }
        }
    }
}

Tiling::Tiling(const PointSource& source, const Partition& partition, double margin,
               const Execution& execution) {
    const std::size_t tiles = partition.boxes().size();
    // Counted first, then written, each part where it belongs: nothing is held twice.
    std::vector<std::size_t> next(kPartsOfPass * tiles, 0);
    const auto for_each_pair = [&](const auto& visit) {
        for_each_point(source, execution,
                       [&](std::size_t part, std::size_t index, const Eigen::Vector3d& place) {
                           partition.for_each_near(place, margin, [&](std::uint32_t tile) {
                               visit(next[part * tiles + tile], index);
                           });
                       });
    };
    for_each_pair([](std::size_t& count, std::size_t) { ++count; });
    first_.push_back(0);
    std::size_t total = 0;
    for (std::size_t tile = 0; tile < tiles; ++tile) {
        for (std::size_t part = 0; part < kPartsOfPass; ++part) {
            total += std::exchange(next[part * tiles + tile], total);
        }
        first_.push_back(total);
    }
    indices_.resize(total);
    for_each_pair([&](std::size_t& at, std::size_t index) {
        indices_[at++] = static_cast<std::uint32_t>(index);
    });
}

std::vector<std::uint32_t> Partition::choose(std::size_t count) const {
    const std::size_t all = boxes_.size();
    const std::size_t some = std::min(count, all);
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < some; ++i) {
        chosen.push_back(static_cast<std::uint32_t>((2 * i + 1) * all / (2 * some)));
    }
    return chosen;
}

std::vector<std::uint8_t> Partition::nodes_above(const std::vector<std::uint32_t>& boxes) const {
    std::vector<std::uint8_t> above(nodes_.size(), 0);
    // Nodes come before those below them.
    for (std::size_t at = nodes_.size(); at-- > 0;) {
        const Node& node = nodes_[at];
        above[at] = node.axis < 0 ? std::ranges::binary_search(boxes, node.low)
                                  : above[node.low] || above[node.high];
    }
    return above;
}

Excerpt make_excerpt(const PointSource& source, const Partition& partition, std::size_t boxes,
                     double margin, const Execution& execution) {
    const std::vector<std::uint32_t> chosen = partition.choose(boxes);
    const Partition::Nearness is_near(partition, chosen, margin);
    Excerpt excerpt;
    for (const std::uint32_t box : chosen) excerpt.boxes.push_back(partition.boxes()[box]);
    std::vector<std::vector<std::uint32_t>> parts(kPartsOfPass);
    for_each_point(source, execution,
                   [&](std::size_t part, std::size_t index, const Eigen::Vector3d& place) {
                       if (!is_near(place)) return;
                       parts[part].push_back(static_cast<std::uint32_t>(index));
                   });
    excerpt.points = joined(parts);
    return excerpt;
}

}  // namespace lpf
