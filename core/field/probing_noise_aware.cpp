// The operator for noisy points: means under a kernel instead of single points.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/probing_kernels.h"
#include "core/field/probing.h"

namespace lpf {
namespace {

/// A raster cell holds the weight and the weighted sums of x, y, z.
constexpr int kChannels = 4;

/// Nodes with less support than one point about 1.5 kernel widths away know nothing...
constexpr float kLeastSupport = 0.3F;
/// ...nor do those with less than this share of the mean support over the disk: beyond a border.
constexpr float kLeastShare = 0.5F;

constexpr float kInfinite = std::numeric_limits<float>::infinity();

class NoiseAwareProbing final : public ProbingOperator {
public:
    NoiseAwareProbing(const Pattern& pattern, double width) : pattern_(pattern) {
        // Nodes of a grid are cells of the raster; other patterns get a raster twice as fine.
        const bool grid = pattern.grid_size() > 0;
        cell_ = grid ? pattern.step() : pattern.step() / 2;
        half_ = grid ? pattern.grid_size() / 2 : static_cast<int>(std::ceil(1 / cell_));
        margin_ = std::max(1, static_cast<int>(std::ceil(3 * width / static_cast<double>(cell_))));
        side_ = 2 * (half_ + margin_) + 1;
        for (int k = -margin_; k <= margin_; ++k) {
            const double t = k * static_cast<double>(cell_) / width;
            taps_.push_back(static_cast<float>(std::exp(-0.5 * t * t)));
        }
        for (int i = 0; i < pattern.size(); ++i) {
            column_.push_back(cell_of(pattern.channel(0)[i]));
            node_cell_.push_back(cell_of(pattern.channel(1)[i]) * side_ + column_.back());
        }
    }

    void probe(const Frame&, bool curve, ProbeScratch& scratch, float* v) const override {
        std::fill_n(v, 3 * pattern_.padded_size(), 0.0F);
        if (scratch.target.size == 0) return;
        if (curve) {
            probe_curve(scratch, v);
        } else {
            probe_surface(scratch, v);
        }
    }

private:
    [[nodiscard]] int cell_of(float coordinate) const {
        const float cell = std::floor(coordinate / cell_ + 0.5F);
        const auto limit = static_cast<float>(half_ + margin_);
        return static_cast<int>(std::clamp(cell, -limit, limit)) + half_ + margin_;
    }

    [[nodiscard]] const float* tap_centre() const { return taps_.data() + margin_; }

    void probe_surface(ProbeScratch& scratch, float* v) const {
        const auto cells = static_cast<std::size_t>(side_ * side_);
        add_to_raster(scratch, side_);
        // Nodes keep `margin_` cells to every side: what wraps around at row ends is never read.
        scratch.raster2.assign(kChannels * cells, 0.0F);
        const int row = kChannels * side_;
        const int begin = margin_ * row;
        const auto inner = static_cast<std::size_t>((side_ - 2 * margin_) * row);
        kernels::convolve(scratch.raster.data() + begin, scratch.raster2.data() + begin, inner, row,
                          tap_centre(), margin_);
        kernels::convolve(scratch.raster2.data() + begin, scratch.raster.data() + begin, inner,
                          kChannels, tap_centre(), margin_);
        read_nodes(scratch, node_cell_, false, v);
    }

    void probe_curve(ProbeScratch& scratch, float* v) const {
        const auto cells = static_cast<std::size_t>(side_);
        add_to_raster(scratch, 1);
        scratch.raster2.assign(kChannels * cells, 0.0F);
        const int begin = margin_ * kChannels;
        kernels::convolve(scratch.raster.data() + begin, scratch.raster2.data() + begin,
                          static_cast<std::size_t>(kChannels * (side_ - 2 * margin_)), kChannels,
                          tap_centre(), margin_);
        scratch.raster.swap(scratch.raster2);
        read_nodes(scratch, column_, true, v);
    }

    void add_to_raster(ProbeScratch& scratch, int rows) const {
        const TargetArea& target = scratch.target;
        scratch.raster.assign(static_cast<std::size_t>(kChannels * side_ * rows), 0.0F);
        kernels::add_to_cells(target.x.data(), target.y.data(), target.z.data(), target.size, cell_,
                              side_, rows, scratch.raster.data());
    }

    /// From the blurred raster to displacements. On a curve the node moves within the
    /// cross-section, on a surface only along the normal; without support it is pulled to the
    /// nearest mean.
    void read_nodes(ProbeScratch& scratch, const std::vector<int>& cell_of_node, bool curve,
                    float* v) const {
        const int m = pattern_.size();
        const int stride = pattern_.padded_size();
        float total = 0;
        for (int i = 0; i < m; ++i) total += cell(scratch, cell_of_node, i)[0];
        const float least = std::max(kLeastSupport, kLeastShare * total / static_cast<float>(m));

        scratch.cells.clear();   // nodes with support
        scratch.cells2.clear();  // nodes without
        for (int i = 0; i < m; ++i) {
            const float* sums = cell(scratch, cell_of_node, i);
            if (sums[0] < least) {
                scratch.cells2.push_back(i);
                continue;
            }
            scratch.cells.push_back(i);
            const float inverse = 1 / sums[0];
            if (curve) v[stride + i] = sums[2] * inverse - pattern_.channel(1)[i];
            v[2 * stride + i] = sums[3] * inverse - pattern_.channel(2)[i];
        }
        pull_to_support(scratch, cell_of_node, curve, v);
    }

    /// Nodes without support go to the mean of the nearest node that has it; along a curve only x
    /// counts.
    void pull_to_support(ProbeScratch& scratch, const std::vector<int>& cell_of_node, bool curve,
                         float* v) const {
        if (scratch.cells.empty() || scratch.cells2.empty()) return;
        const int stride = pattern_.padded_size();
        const float* x = pattern_.channel(0);
        const float* y = curve ? x : pattern_.channel(1);
        const std::size_t n = (scratch.cells.size() + 15) / 16 * 16;
        scratch.raster2.assign(2 * n, kInfinite);  // nothing is nearer than what fills it up
        float* const near_x = scratch.raster2.data();
        float* const near_y = near_x + n;
        for (std::size_t k = 0; k < scratch.cells.size(); ++k) {
            near_x[k] = x[scratch.cells[k]];
            near_y[k] = y[scratch.cells[k]];
        }
        for (const int i : scratch.cells2) {
            const std::size_t nearest = kernels::nearest_to_place(near_x, near_y, n, x[i], y[i]);
            const float* sums = cell(scratch, cell_of_node, scratch.cells[nearest]);
            for (int c = 0; c < 3; ++c) {
                v[c * stride + i] = sums[c + 1] / sums[0] - pattern_.channel(c)[i];
            }
        }
    }

    [[nodiscard]] static const float* cell(const ProbeScratch& scratch,
                                           const std::vector<int>& cell_of_node, int node) {
        return scratch.raster.data() + kChannels * cell_of_node[static_cast<std::size_t>(node)];
    }

    Pattern pattern_;
    float cell_ = 0;
    int half_ = 0;
    int margin_ = 0;
    int side_ = 0;
    std::vector<float> taps_;
    std::vector<int> node_cell_;  // in the plane
    std::vector<int> column_;     // along t1
};

}  // namespace

std::unique_ptr<ProbingOperator> make_noise_aware_probing(const Pattern& pattern, double width) {
    return std::make_unique<NoiseAwareProbing>(pattern, width);
}

}  // namespace lpf
