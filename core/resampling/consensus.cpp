#include "core/resampling/consensus.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <utility>

#include "core/base/memory.h"
#include "core/field/target_area.h"
#include "core/shape/hash_grid.h"

namespace lpf {
namespace {

/// Side of a cell [tau_p]. Points lie up to one tau_p outside the cell of their candidate, and
/// candidates are spent up to one further: cells of one colour must be further apart.
constexpr double kCellSide = 24.0;

constexpr std::size_t kColours = 8;

/// While points are handed out, the memory of their cells is given back after so many.
constexpr std::size_t kPointsPerReturn = std::size_t{1} << 20U;

/// The parity of its coordinates: two cells of one colour have one of another between them.
std::size_t colour_of(const Cell& cell) {
    return static_cast<std::size_t>((cell.x() & 1) | (cell.y() & 1) << 1 | (cell.z() & 1) << 2);
}

bool is_free(const HashGrid& accepted, const Eigen::Vector3d& at) {
    bool free = true;
    accepted.for_each_near(at, [&](std::uint32_t, const Eigen::Vector3d&) { return free = false; });
    return free;
}

}  // namespace

/// The candidates of one call, sorted so that those around a place lie together in memory, and
/// which of them are spent.
class Consensus::Pass {
public:
    Pass(const Candidates& candidates, double spacing, const Execution& execution)
        : candidates_(candidates),
          spacing_(spacing),
          grid_(candidates.points, spacing, execution),
          spent_(candidates.size(), 0) {}

    /// @param space of the cell  @param around points accepted before, up to two tau_p from it
    void settle(const Members& members, const Eigen::AlignedBox3d& space,
                const std::vector<Eigen::Vector3d>& around, Settled& settled) {
        TargetArea near;
        HashGrid accepted(space.min(), space.sizes().maxCoeff(), spacing_);
        const auto accept = [&](const Eigen::Vector3d& point) {
            accepted.add(point);
            gather(point, near);
            for (std::size_t k = 0; k < near.size; ++k) spent_[grid_.order()[near.index[k]]] = 1;
        };
        for (const Eigen::Vector3d& point : around) accept(point);
        for (const std::uint32_t i : members) {
            if (spent_[i]) continue;
            const Eigen::Vector3d proposed = candidates_.points.col(static_cast<Eigen::Index>(i));
            Eigen::Vector3d point = mean_around(proposed, near);
            // The mean may run into a point accepted before; the proposal itself is free then.
            if (!is_free(accepted, point)) point = proposed;
            if (!is_free(accepted, point)) continue;
            accept(point);
            settled.points.push_back(point);
            settled.field.push_back(candidates_.field[i]);
        }
        settled.points.shrink_to_fit();
        settled.field.shrink_to_fit();
    }

private:
    void gather(const Eigen::Vector3d& at, TargetArea& near) const {
        grid_.gather(at, spacing_, 1.0F, near);
    }

    Eigen::Vector3d mean_around(const Eigen::Vector3d& at, TargetArea& near) const {
        gather(at, near);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t i = 0; i < near.size; ++i) {
            sum += Eigen::Vector3d(near.x[i], near.y[i], near.z[i]);
        }
        return at + spacing_ / static_cast<double>(near.size) * sum;
    }

    const Candidates& candidates_;
    double spacing_;
    PointGrid grid_;
    std::vector<std::uint8_t> spent_;
};

Consensus::Consensus(const Eigen::Vector3d& middle, double spacing)
    : spacing_(spacing),
      lattice_{middle.array() - 0.5 * kCellSide * spacing, kCellSide * spacing} {}

Consensus::PerCell<Consensus::Members> Consensus::members(const Candidates& candidates,
                                                          const CellBox& box) const {
    PerCell<Members> result;
    Cell last = Cell::Zero();
    Members* of_last = nullptr;  // candidates that follow each other mostly share their cell
    for (std::uint32_t i = 0; i < candidates.size(); ++i) {
        const Cell cell = lattice_.cell_of(candidates.points.col(static_cast<Eigen::Index>(i)));
        if (!box.holds(cell)) continue;
        if (of_last == nullptr || cell != last) of_last = &result[cell];
        last = cell;
        of_last->push_back(i);
    }
    return result;
}

std::vector<Eigen::Vector3d> Consensus::settled_around(const Cell& cell) const {
    const Eigen::AlignedBox3d space = lattice_.space_of({cell, cell + Cell::Ones()});
    const Eigen::AlignedBox3d near = widened(space, 2.01 * spacing_);
    std::vector<Eigen::Vector3d> points;
    for_each_neighbour(cell, [&](const Cell& neighbour) {
        const auto found = settled_.find(neighbour);
        if (found == settled_.end()) return;
        std::ranges::copy_if(found->second.points, std::back_inserter(points),
                             [&](const Eigen::Vector3d& point) { return near.contains(point); });
    });
    return points;
}

void Consensus::settle(const Candidates& candidates, const CellBox& box,
                       const Execution& execution) {
    if (candidates.size() == 0) return;
    Pass pass(candidates, spacing_, execution);
    struct Work {
        Cell cell;
        const Members* members;
        Settled* settled;
    };
    std::array<std::vector<Work>, kColours> colours;
    const PerCell<Members> all_members = members(candidates, box);
    for (const auto& [cell, of_cell] : all_members) {
        colours[colour_of(cell)].push_back({cell, &of_cell, &settled_[cell]});
    }
    for (std::size_t colour = 0; colour < kColours; ++colour) {
        std::vector<Work>& works = colours[colour];
        std::ranges::stable_sort(works, std::greater{},
                                 [](const Work& w) { return w.members->size(); });
        const double done = static_cast<double>(colour) / kColours;
        parallel_for(part_of(execution, done, done + 1.0 / kColours), "consensus", "cells",
                     works.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
                         const auto& [cell, of_cell, settled] = works[i];
                         pass.settle(*of_cell, lattice_.space_of({cell, cell + Cell::Ones()}),
                                     settled_around(cell), *settled);
                     });
    }
}

std::size_t Consensus::size() const {
    std::size_t sum = 0;
    for (const auto& [cell, settled] : settled_) sum += settled.field.size();
    return sum;
}

Candidates Consensus::take() {
    Candidates all{Points(3, static_cast<Eigen::Index>(size())), {}};
    all.field.reserve(size());
    Eigen::Index i = 0;
    std::size_t taken = 0;
    while (!settled_.empty()) {
        const Settled settled = std::move(settled_.extract(settled_.begin()).mapped());
        for (const Eigen::Vector3d& point : settled.points) all.points.col(i++) = point;
        all.field.insert(all.field.end(), settled.field.begin(), settled.field.end());
        taken += settled.field.size();
        if (taken < kPointsPerReturn) continue;
        return_freed_memory();
        taken = 0;
    }
    return all;
}

Candidates find_consensus(const Candidates& candidates, double spacing,
                          const Execution& execution) {
    if (candidates.size() == 0) return {};
    const auto middle = static_cast<Eigen::Index>(candidates.size() / 2);
    Consensus consensus(candidates.points.col(middle), spacing);
    consensus.settle(candidates, CellLattice::everything(), execution);
    return consensus.take();
}

}  // namespace lpf
