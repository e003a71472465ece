// The operators that assign one target point to each pattern point.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/probing_kernels.h"
#include "core/field/probing.h"

namespace lpf {
namespace {

void set_displacement(const Pattern& pattern, const TargetArea& target, int node, std::size_t point,
                      float* v) {
    const int stride = pattern.padded_size();
    v[node] = target.x[point] - pattern.channel(0)[node];
    v[stride + node] = target.y[point] - pattern.channel(1)[node];
    v[2 * stride + node] = target.z[point] - pattern.channel(2)[node];
}

/// Target points binned into square cells over the plane, for a nearest search ring by ring.
class PlaneBins {
public:
    PlaneBins(const TargetArea& target, std::vector<int>& first, std::vector<int>& members)
        : target_(target), first_(first), members_(members) {
        for (std::size_t i = 0; i < target.size; ++i) {
            reach_ = std::max({reach_, std::abs(target.x[i]), std::abs(target.y[i])});
        }
        // About two points a cell.
        side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<float>(target.size) / 2)), 1, 64);
        inverse_cell_ = static_cast<float>(side_) / (2 * reach_);
        sort_points();
    }

    /// The point nearest to (x, y) in the plane; of equally near ones the first of the target area.
    [[nodiscard]] int nearest(float x, float y) const {
        const int column = cell_of(x);
        const int row = cell_of(y);
        Best best;
        for (int ring = 0; ring < side_; ++ring) {
            visit_ring(column, row, ring, x, y, best);
            // Every cell beyond this ring is at least that far from (x, y).
            const float free = static_cast<float>(ring) / inverse_cell_ + border_distance(x, y);
            if (best.point >= 0 && best.squared <= free * free) break;
        }
        return best.point;
    }

private:
    struct Best {
        int point = -1;
        float squared = std::numeric_limits<float>::infinity();
    };

    [[nodiscard]] int cell_of(float coordinate) const {
        return std::clamp(static_cast<int>((coordinate + reach_) * inverse_cell_), 0, side_ - 1);
    }

    /// Distance of (x, y) to the nearest side of its own cell; 0 if it was clamped into it.
    [[nodiscard]] float border_distance(float x, float y) const {
        const float inside_x = (x + reach_) - static_cast<float>(cell_of(x)) / inverse_cell_;
        const float inside_y = (y + reach_) - static_cast<float>(cell_of(y)) / inverse_cell_;
        const float cell = 1 / inverse_cell_;
        return std::max(0.0F, std::min({inside_x, inside_y, cell - inside_x, cell - inside_y}));
    }

    void sort_points() {
        first_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
        members_.resize(2 * target_.size);
        int* cell_of_point = members_.data() + target_.size;
        for (std::size_t i = 0; i < target_.size; ++i) {
            cell_of_point[i] = cell_of(target_.y[i]) * side_ + cell_of(target_.x[i]);
            ++first_[static_cast<std::size_t>(cell_of_point[i]) + 1];
        }
        for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
        // Backwards, each cell filled from its end: first_[c + 1] sinks to the start of cell c.
        for (std::size_t i = target_.size; i-- > 0;) {
            const auto end = static_cast<std::size_t>(cell_of_point[i]) + 1;
            members_[static_cast<std::size_t>(--first_[end])] = static_cast<int>(i);
        }
        std::rotate(first_.begin(), first_.begin() + 1, first_.end());
        first_.back() = static_cast<int>(target_.size);
    }

    void visit_ring(int column, int row, int ring, float x, float y, Best& best) const {
        const int top = std::max(row - ring, 0);
        const int bottom = std::min(row + ring, side_ - 1);
        for (int j = top; j <= bottom; ++j) {
            const bool full = std::abs(j - row) == ring;
            const int step = full || ring == 0 ? 1 : 2 * ring;
            for (int i = column - ring; i <= column + ring; i += step) {
                if (i >= 0 && i < side_) visit_cell(j * side_ + i, x, y, best);
            }
        }
    }

    void visit_cell(int cell, float x, float y, Best& best) const {
        const auto c = static_cast<std::size_t>(cell);
        for (int k = first_[c]; k < first_[c + 1]; ++k) {
            const int point = members_[static_cast<std::size_t>(k)];
            const auto p = static_cast<std::size_t>(point);
            const float dx = target_.x[p] - x;
            const float dy = target_.y[p] - y;
            const float squared = dx * dx + dy * dy;
            if (squared < best.squared || (squared == best.squared && point < best.point)) {
                best = {point, squared};
            }
        }
    }

    const TargetArea& target_;
    std::vector<int>& first_;
    std::vector<int>& members_;
    float reach_ = 1e-6F;
    int side_ = 1;
    float inverse_cell_ = 1.0F;
};

/// Target points sorted by the row of a grid pattern's nodes that they lie nearest to.
class PointRows {
public:
    PointRows(const TargetArea& target, float step, int half, ProbeScratch& scratch)
        : size_(target.size), first_(scratch.cells), sorted_(scratch.raster) {
        const std::size_t n = target.size;
        const auto limit = static_cast<float>(half);
        const float per_step = 1.0F / step;
        first_.assign(2 * static_cast<std::size_t>(half) + 2, 0);
        int* const count = first_.data() + 1;
        std::vector<int>& row = scratch.cells2;
        row.resize(2 * n);
        int* const place = row.data() + n;  // among those of its row
        for (std::size_t i = 0; i < n; ++i) {
            const float at = std::clamp(target.y[i] * per_step, -limit, limit);
            row[i] = static_cast<int>(at + limit + 0.5F);
        }
        for (std::size_t i = 0; i < n; ++i) place[i] = count[row[i]]++;
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        sorted_.resize(3 * n + 16);  // y is read by whole registers
        for (std::size_t i = 0; i < n; ++i) {
            float* const to = sorted_.data() + first_[static_cast<std::size_t>(row[i])] + place[i];
            to[0] = target.x[i];
            to[n] = target.y[i];
            to[2 * n] = target.z[i];
        }
    }

    [[nodiscard]] int begin_of(int row) const { return first_[static_cast<std::size_t>(row)]; }
    [[nodiscard]] int size() const { return static_cast<int>(size_); }

    /// Channel c (0 = x, 1 = y, 2 = z) of the points from that one on.
    [[nodiscard]] const float* channel(std::size_t c, int from) const {
        return sorted_.data() + c * size_ + from;
    }

private:
    std::size_t size_;
    std::vector<int>& first_;
    std::vector<float>& sorted_;
};

/// On a grid: 16 nodes of a row at a time look at the points in the rows about them.
class GridProbing final : public ProbingOperator {
public:
    explicit GridProbing(const Pattern& pattern)
        : pattern_(pattern), half_(pattern.grid_size() / 2) {
        for (int i = 0; i < pattern.size();) {
            Run run{.first_node = i, .row = row_of(i), .nodes = 0};
            while (i < pattern.size() && run.nodes < static_cast<int>(kLanes) &&
                   row_of(i) == run.row) {
                ++run.nodes;
                ++i;
            }
            runs_.push_back(run);
        }
    }

    void probe(const Frame&, bool, ProbeScratch& scratch, float* v) const override {
        const TargetArea& target = scratch.target;
        if (target.size == 0) {
            std::fill_n(v, 3 * pattern_.padded_size(), 0.0F);
            return;
        }
        const PointRows rows(target, pattern_.step(), half_, scratch);
        const int reach = reach_for(target);
        for (const Run& run : runs_) {
            // Seldom are the rows next to it not enough; a node at a hole asks for all of them.
            if (look(run, rows, reach, v) || look(run, rows, 2 * reach, v)) continue;
            look(run, rows, 2 * half_, v);
        }
        clear_padding(v);
    }

private:
    static constexpr std::size_t kLanes = 16;
    /// So many points within the reach of a node make it unlikely that none is.
    static constexpr float kPointsInReach = 5.5F;

    /// Nodes one beside the other.
    struct Run {
        int first_node;
        int row;
        int nodes;
    };

    /// Displaces the nodes of a run to the nearest points in so many rows to either side.
    /// @returns whether no other point can be nearer
    bool look(const Run& run, const PointRows& rows, int reach, float* v) const {
        const int low = std::max(run.row - reach, 0);
        const int high = std::min(run.row + reach, 2 * half_);
        const int begin = rows.begin_of(low);
        const int end = rows.begin_of(high + 1);
        if (begin == end) return false;
        const std::size_t padded = static_cast<std::size_t>(pattern_.padded_size());
        const auto first = static_cast<std::size_t>(run.first_node);
        // Lanes behind the run are those of runs to come, but for the last.
        const bool fits = first + kLanes <= padded;
        float found[3 * kLanes];
        const float furthest = kernels::nearest_to_nodes(
            rows.channel(0, begin), rows.channel(1, begin), rows.channel(2, begin),
            static_cast<std::size_t>(end - begin), pattern_.channel(0)[first], pattern_.step(),
            pattern_.channel(1)[first], run.nodes, fits ? v + first : found,
            fits ? padded : kLanes);
        for (std::size_t c = 0; c < 3 && !fits; ++c) {
            std::copy_n(found + c * kLanes, run.nodes, v + c * padded + first);
        }
        const float sure = pattern_.step() * (static_cast<float>(reach) + 0.49F);
        return furthest <= sure * sure || end - begin == rows.size();
    }

    void clear_padding(float* v) const {
        for (int c = 0; c < 3; ++c) {
            float* const channel = v + c * pattern_.padded_size();
            std::fill(channel + pattern_.size(), channel + pattern_.padded_size(), 0.0F);
        }
    }

    [[nodiscard]] int row_of(int node) const {
        const long row = std::lround(pattern_.channel(1)[node] / pattern_.step());
        return static_cast<int>(row) + half_;
    }

    /// Rows to either side that are looked at first.
    [[nodiscard]] int reach_for(const TargetArea& target) const {
        constexpr float kPi = std::numbers::pi_v<float>;
        const float points_of_node =
            static_cast<float>(target.size) * pattern_.step() * pattern_.step() / kPi;
        const float reach = std::sqrt(kPointsInReach / (kPi * points_of_node)) - 0.5F;
        return std::clamp(static_cast<int>(std::ceil(reach)), 1, half_);
    }

    Pattern pattern_;
    int half_;
    std::vector<Run> runs_;
};

/// On any pattern: each node looks around itself.
class OrthogonalProbing final : public ProbingOperator {
public:
    explicit OrthogonalProbing(const Pattern& pattern) : pattern_(pattern) {}

    void probe(const Frame&, bool, ProbeScratch& scratch, float* v) const override {
        std::fill_n(v, 3 * pattern_.padded_size(), 0.0F);
        if (scratch.target.size == 0) return;
        const PlaneBins bins(scratch.target, scratch.cells, scratch.cells2);
        for (int i = 0; i < pattern_.size(); ++i) {
            const int point = bins.nearest(pattern_.channel(0)[i], pattern_.channel(1)[i]);
            set_displacement(pattern_, scratch.target, i, static_cast<std::size_t>(point), v);
        }
    }

private:
    Pattern pattern_;
};

class NearestPointProbing final : public ProbingOperator {
public:
    explicit NearestPointProbing(const Pattern& pattern) : pattern_(pattern) {}

    void probe(const Frame&, bool, ProbeScratch& scratch, float* v) const override {
        std::fill_n(v, 3 * pattern_.padded_size(), 0.0F);
        const TargetArea& target = scratch.target;
        for (int i = 0; i < pattern_.size() && target.size > 0; ++i) {
            const Eigen::Vector3f u = pattern_.point(i);
            std::size_t best = 0;
            float best_squared = std::numeric_limits<float>::infinity();
            for (std::size_t k = 0; k < target.size; ++k) {
                const float squared =
                    (Eigen::Vector3f(target.x[k], target.y[k], target.z[k]) - u).squaredNorm();
                if (squared < best_squared) {
                    best = k;
                    best_squared = squared;
                }
            }
            set_displacement(pattern_, target, i, best, v);
        }
    }

private:
    Pattern pattern_;
};

}  // namespace

std::unique_ptr<ProbingOperator> make_orthogonal_probing(const Pattern& pattern) {
    if (pattern.grid_size() > 0) return std::make_unique<GridProbing>(pattern);
    return std::make_unique<OrthogonalProbing>(pattern);
}

std::unique_ptr<ProbingOperator> make_nearest_point_probing(const Pattern& pattern) {
    return std::make_unique<NearestPointProbing>(pattern);
}

}  // namespace lpf
