#include "core/resampling/blocks.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>

namespace lpf {
namespace {

class Divider {
public:
    Divider(const std::vector<Frame>& frames, const CellLattice& cells, double margin,
            std::size_t most)
        : frames_(frames), cells_(cells), margin_(margin), most_(most) {}

    std::vector<Block> run() {
        std::vector<std::uint32_t> all(frames_.size());
        std::iota(all.begin(), all.end(), 0U);
        divide({CellLattice::everything(), std::move(all)});
        return std::move(result_);
    }

private:
    void divide(Block block) {
        if (block.fields.size() > most_) {
            for (const int axis : axes_by_extent(block.fields)) {
                if (divide_along(axis, block)) return;
            }
        }
        if (!block.fields.empty()) result_.push_back(std::move(block));
    }

    /// Longest extent of the centres first.
    [[nodiscard]] std::array<int, 3> axes_by_extent(
        const std::vector<std::uint32_t>& fields) const {
        Eigen::AlignedBox3d extent;
        for (const std::uint32_t j : fields) extent.extend(frames_[j].centre);
        std::array<int, 3> axes{0, 1, 2};
        std::ranges::stable_sort(axes, std::greater{}, [&](int a) { return extent.sizes()[a]; });
        return axes;
    }

    /// @returns whether there is a border of cells that divides the LPFs into two parts
    bool divide_along(int axis, Block& block) {
        const std::int64_t at = border(axis, block);
        if (at <= block.box.low[axis] || at >= block.box.high[axis]) return false;
        Block low{block.box, {}};
        Block high{block.box, {}};
        low.box.high[axis] = at;
        high.box.low[axis] = at;
        low.fields = near(low.box, block.fields);
        high.fields = near(high.box, block.fields);
        // Where LPFs reach across many cells, dividing further would only repeat work.
        if (2 * (low.fields.size() + high.fields.size()) > 3 * block.fields.size()) return false;
        block.fields = std::vector<std::uint32_t>();
        divide(std::move(low));
        divide(std::move(high));
        return true;
    }

    /// The border of cells that is nearest to the median of the centres.
    [[nodiscard]] std::int64_t border(int axis, const Block& block) const {
        std::vector<double> centres;
        for (const std::uint32_t j : block.fields) centres.push_back(frames_[j].centre[axis]);
        const auto middle = centres.begin() + static_cast<std::ptrdiff_t>(centres.size() / 2);
        std::ranges::nth_element(centres, middle);
        Eigen::Vector3d place = cells_.corner;
        place[axis] = *middle + 0.5 * cells_.side;
        return cells_.cell_of(place)[axis];
    }

    [[nodiscard]] std::vector<std::uint32_t> near(const CellBox& box,
                                                  const std::vector<std::uint32_t>& fields) const {
        return fields_near(frames_, fields, widened(cells_.space_of(box), margin_));
    }

    const std::vector<Frame>& frames_;
    const CellLattice& cells_;
    double margin_;
    std::size_t most_;
    std::vector<Block> result_;
};

}  // namespace

std::vector<Block> divide(const std::vector<Frame>& frames, const CellLattice& cells, double margin,
                          std::size_t most) {
    return Divider(frames, cells, margin, most).run();
}

std::vector<std::uint32_t> fields_near(const std::vector<Frame>& frames,
                                       const std::vector<std::uint32_t>& numbers,
                                       const Eigen::AlignedBox3d& space) {
    std::vector<std::uint32_t> near;
    std::ranges::copy_if(numbers, std::back_inserter(near), [&](std::uint32_t j) {
        return space.exteriorDistance(frames[j].centre) <= kProposalReach * frames[j].radius;
    });
    return near;
}

}  // namespace lpf
