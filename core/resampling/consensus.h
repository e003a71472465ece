#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/base/parallel.h"
#include "core/resampling/cells.h"
#include "core/shape/point_cloud.h"

namespace lpf {

/// Points that LPFs propose for a resampling, in the order in which they are to be considered.
struct Candidates {
    Points points;                     ///< 3 x K [input length]
    std::vector<std::uint32_t> field;  ///< K, the LPF that proposes each

    [[nodiscard]] std::size_t size() const { return field.size(); }
};

/// A consensus of candidates (paper Sec. 4.1, Eq. 8), found greedily: the mean of all candidates
/// within tau_p of one becomes a point, unless one is that near already, and all candidates within
/// tau_p of it are spent. No two points are nearer than tau_p.
/// Departs from the text, which bounds a length by tau_p squared.
///
/// Candidates are considered cell by cell, so that several threads can work and a part of the shape
/// can be done with before the next. Cells of one colour touch none of their own: what they accept
/// does not depend on each other. Each candidate is considered once, in the cell that holds it, and
/// looks at all the points and candidates around it, whatever their cell: the result is that of
/// one greedy pass in this order, without seams.
class Consensus {
public:
    /// @param middle of a cell [input length]  @param spacing tau_p [input length], > 0
    Consensus(const Eigen::Vector3d& middle, double spacing);

    [[nodiscard]] const CellLattice& cells() const { return lattice_; }

    /// Considers the candidates in a box of cells, after those of the boxes before.
    /// @param candidates all that lie in the box or within tau_p around it
    void settle(const Candidates& candidates, const CellBox& box, const Execution& execution);

    /// Number of points so far.
    [[nodiscard]] std::size_t size() const;

    /// Hands out the points, cell by cell, each with the LPF that proposed it first.
    [[nodiscard]] Candidates take();

private:
    struct Settled {
        std::vector<Eigen::Vector3d> points;
        std::vector<std::uint32_t> field;
    };
    template <typename Value>
    using PerCell = std::map<Cell, Value, CellsByRows>;
    using Members = std::vector<std::uint32_t>;
    class Pass;

    [[nodiscard]] PerCell<Members> members(const Candidates& candidates, const CellBox& box) const;
    [[nodiscard]] std::vector<Eigen::Vector3d> settled_around(const Cell& cell) const;

    double spacing_;
    CellLattice lattice_;
    PerCell<Settled> settled_;
};

/// The consensus of one set of candidates.
[[nodiscard]] Candidates find_consensus(const Candidates& candidates, double spacing,
                                        const Execution& execution);

}  // namespace lpf
